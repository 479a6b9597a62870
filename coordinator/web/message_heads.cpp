#include "coordinator/web/message_heads.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/verb.hpp>

#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

namespace http = boost::beast::http;

/// How many bytes the body has; nothing where that is not known before they are sent.
std::optional<uint64_t> length_of(const WebReply& reply) {
  if (reply.source) return reply.source->size();
  if (reply.text) return reply.text->size();
  return reply.topic ? std::nullopt : std::optional<uint64_t>(0);
}

}  // namespace

WebRequest request_of(const RequestHead& head) {
  WebRequest request;
  request.method = head.method() == http::verb::head ? "GET" : std::string(head.method_string());
  request.target = std::string(head.target());
  for (const auto& field : head) {
    const std::string name(field.name_string());
    request.headers[core::lower_case(name)] = std::string(field.value());
  }
  return request;
}

grpc::Status check_framing(const RequestHead& head) {
  const auto refuse = [](const char* why) {
    return grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, why);
  };
  const auto hosts = head.count(http::field::host);
  if (hosts > 1) return refuse("the request names more than one host");
  if (hosts == 0 && head.version() >= 11) return refuse("the request names no host");
  if (head.count(http::field::transfer_encoding) == 0) return grpc::Status::OK;
  if (head.version() < 11) return refuse("HTTP/1.0 has no Transfer-Encoding");
  if (head.count(http::field::transfer_encoding) > 1 ||
      core::lower_case(std::string(head[http::field::transfer_encoding])) != "chunked") {
    return refuse("of Transfer-Encoding only 'chunked' is known");
  }
  if (head.count(http::field::content_length) > 0) {
    return refuse("a body has Content-Length or Transfer-Encoding, not both");
  }
  return grpc::Status::OK;
}

void leave_out_known(WebReply& reply, const std::string& known) {
  if (reply.status != 200 || known.empty()) return;
  const auto tag = std::find_if(reply.headers.begin(), reply.headers.end(),
                                [](const auto& header) { return header.first == "ETag"; });
  if (tag == reply.headers.end() || known.find(tag->second) == std::string::npos) return;
  reply.status = 304;
  reply.type.clear();
  reply.source.reset();
  reply.text = std::make_shared<const std::string>();
}

ReplyHead head_of(const WebReply& reply, unsigned version, bool& keep_alive) {
  ReplyHead head;
  head.version(version);
  head.result(reply.status);
  head.set(http::field::server, "Hyades");
  if (!reply.type.empty()) head.set(http::field::content_type, reply.type);
  head.set("X-Content-Type-Options", "nosniff");
  for (const auto& [name, value] : reply.headers) head.set(name, value);
  const std::optional<uint64_t> length = length_of(reply);
  const bool goes_on = reply.topic || (reply.source && reply.source->goes_on());
  if (goes_on) keep_alive = false;
  if (reply.status == 204 || reply.status == 304) {
    // No body, so no length.
  } else if (length) {
    head.set(http::field::content_length, std::to_string(*length));
  } else if (!goes_on && version >= 11) {
    head.chunked(true);
  } else {
    keep_alive = false;  // the end of the body is that of the connection
  }
  head.keep_alive(keep_alive);
  return head;
}

}  // namespace hyades::coordinator
