#pragma once

#include <string>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

using RequestHead = boost::beast::http::request_header<>;
using ReplyHead = boost::beast::http::response<boost::beast::http::empty_body>;

/// The method and the headers of a request; HEAD becomes GET. Its target is for parse_target().
WebRequest request_of(const RequestHead& head);

/// Why a request cannot be taken for one: another program on its way may have read another request,
/// or two, in the same bytes, or sent it to another host (RFC 9112, 3.2 and 6.1). OK else. A body
/// is counted (Content-Length) or chunked, and never both; HTTP/1.1 names one host.
grpc::Status check_framing(const RequestHead& head);

/// Makes of a reply whose ETag is among `known` (a header If-None-Match) one that says only that
/// the client has it already (304).
void leave_out_known(WebReply& reply, const std::string& known);

/// The head of a reply in HTTP `version` (10, 11). `keep_alive`: whether the connection may serve
/// another request afterwards; false from then on where only its end tells that of the body.
ReplyHead head_of(const WebReply& reply, unsigned version, bool& keep_alive);

}  // namespace hyades::coordinator
