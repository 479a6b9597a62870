#include "coordinator/web/exchange.h"

#include <fmt/format.h>

#include "coordinator/access/audit_log.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// For who has as much as an owner may have, where 503 is for a coordinator that is busy.
constexpr unsigned kTooMuch = 429;

unsigned http_status_of(grpc::StatusCode code) {
  constexpr std::pair<grpc::StatusCode, unsigned> kStatuses[] = {
      {grpc::StatusCode::CANCELLED, 499},           {grpc::StatusCode::INVALID_ARGUMENT, 400},
      {grpc::StatusCode::DEADLINE_EXCEEDED, 504},   {grpc::StatusCode::NOT_FOUND, 404},
      {grpc::StatusCode::ALREADY_EXISTS, 409},      {grpc::StatusCode::PERMISSION_DENIED, 403},
      {grpc::StatusCode::UNAUTHENTICATED, 401},     {grpc::StatusCode::RESOURCE_EXHAUSTED, 503},
      {grpc::StatusCode::FAILED_PRECONDITION, 409}, {grpc::StatusCode::ABORTED, 409},
      {grpc::StatusCode::OUT_OF_RANGE, 416},        {grpc::StatusCode::UNIMPLEMENTED, 501},
      {grpc::StatusCode::UNAVAILABLE, 503},         {grpc::StatusCode::DATA_LOSS, 422}};
  for (const auto& [known, http] : kStatuses) {
    if (known == code) return http;
  }
  return 500;
}

std::shared_ptr<const std::string> dump(const farm::Json& json) {
  // What is no UTF-8 becomes a replacement character, not an exception.
  return std::make_shared<const std::string>(
      json.dump(-1, ' ', false, farm::Json::error_handler_t::replace));
}

}  // namespace

const std::string& WebRequest::header(const std::string& name) const {
  static const std::string none;
  const auto found = headers.find(name);
  return found == headers.end() ? none : found->second;
}

WebReply json_reply(const farm::Json& json) {
  WebReply reply;
  reply.headers.emplace_back("Cache-Control", "no-store");
  reply.text = dump(json);
  return reply;
}

WebReply text_reply(std::string text, const char* type) {
  WebReply reply;
  reply.type = type;
  reply.text = std::make_shared<const std::string>(std::move(text));
  return reply;
}

WebReply empty_reply(unsigned status) {
  WebReply reply;
  reply.status = status;
  reply.type.clear();
  reply.text = std::make_shared<const std::string>();
  return reply;
}

WebReply error_reply(const grpc::Status& status) {
  const v1::ErrorDetail detail = farm::detail_of(status);
  const unsigned code = detail.quota() ? kTooMuch : http_status_of(status.error_code());
  farm::Json error = {{"code", result_name(status)}, {"message", status.error_message()}};
  if (detail.retry_after_ms() > 0) error["retry_after_ms"] = detail.retry_after_ms();
  if (detail.missing_size() > 0) {
    farm::Json missing = farm::Json::array();
    for (const std::string& digest : detail.missing()) {
      missing.push_back(farm::hex_from_wire(digest));
    }
    error["missing"] = std::move(missing);
  }
  WebReply reply = json_reply({{"error", std::move(error)}});
  reply.status = code;
  if (detail.retry_after_ms() > 0) {
    reply.headers.emplace_back("Retry-After",
                               std::to_string((detail.retry_after_ms() + 999) / 1000));
  }
  if (code == 401) reply.headers.emplace_back("WWW-Authenticate", "Bearer");
  return reply;
}

}  // namespace hyades::coordinator
