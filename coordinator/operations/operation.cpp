#include "coordinator/operations/operation.h"

#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>

#include "coordinator/access/audit_log.h"
#include "coordinator/access/authority.h"
#include "coordinator/operations/ownership.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using google::protobuf::FieldDescriptor;

constexpr size_t kMostDetail = 500;  ///< bytes of a request that the audit log tells

/// What is on no row.
const Operation& unknown() {
  static const Operation row = {
      .rule = {.action = "unknown", .least = v1::ROLE_ADMIN, .audited = true}};
  return row;
}

uint64_t job_of(const Message& request) {
  const auto* job = request.GetDescriptor()->FindFieldByName("job");
  return request.GetReflection()->GetUInt64(request, job);
}

/// A field that holds one number, text or message; as text.
std::string field_text(const Message& message, const char* name) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated()) return {};
  const auto* reflection = message.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_UINT64: {
      const uint64_t number = reflection->GetUInt64(message, field);
      return number == 0 ? std::string() : std::to_string(number);
    }
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection->GetString(message, field);
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return reflection->HasField(message, field)
                 ? field_text(reflection->GetMessage(message, field), "id")
                 : std::string();
    default:
      return {};
  }
}

/// What a request was about, for the audit log: its job, worker or token; of one that makes
/// something, what the response has.
std::string audit_target(const Message& request, const Message& response) {
  for (const Message* message : {&request, &response}) {
    for (const char* name : {"job", "worker", "id", "token"}) {
      if (std::string text = field_text(*message, name); !text.empty()) return text;
    }
  }
  return {};
}

/// Digests as people compare them.
class HexBytes : public google::protobuf::TextFormat::FastFieldValuePrinter {
 public:
  void PrintBytes(const std::string& value,
                  google::protobuf::TextFormat::BaseTextGenerator* out) const override {
    out->PrintString(farm::hex_from_wire(value));
  }
};

/// What a request says, in one line; nothing of one that is long.
std::string audit_detail(const Message& request) {
  if (request.ByteSizeLong() > kMostDetail) return {};
  google::protobuf::TextFormat::Printer printer;
  printer.SetSingleLineMode(true);
  printer.SetDefaultFieldValuePrinter(new HexBytes);  // the printer's own from now on
  std::string text;
  printer.PrintToString(request, &text);
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

using Index = std::map<std::string_view, const Operation*>;

const Operation& find(const Index& index, std::string_view name) {
  const auto found = index.find(name);
  return found == index.end() ? unknown() : *found->second;
}

}  // namespace

std::span<const Operation> all_operations() {
  static const std::vector<Operation> table = [] {
    std::vector<Operation> all;
    for (auto* rows : {farm_operations, token_operations, job_operations, asset_operations}) {
      for (Operation& row : rows()) all.push_back(std::move(row));
    }
    return all;
  }();
  return table;
}

const Operation& operation_of_method(std::string_view method) {
  static const Index by_method = [] {
    Index index;
    for (const Operation& row : all_operations()) index[row.method] = &row;
    index.erase("");
    return index;
  }();
  return find(by_method, method);
}

const Operation& operation_of_route(std::string_view route) {
  static const Index by_route = [] {
    Index index;
    for (const Operation& row : all_operations()) {
      for (const Route& one : row.routes) index[one.path] = &row;
    }
    return index;
  }();
  // Files of the dashboard have a route each.
  return find(by_route, route.starts_with("GET /dashboard/") ? kDashboardFiles : route);
}

const Route& find_route(const Operation& operation, std::string_view route) {
  static const Route none = {""};
  for (const Route& one : operation.routes) {
    if (one.path == route) return one;
  }
  return none;
}

void carry_out(const Operation& operation, const Handler& handle, Backend& at, Message& request,
               const Caller& caller, const Respond<Message>& respond) {
  Respond<Message> then = respond;
  if (AuditLog* log = at.authority.audit(); log != nullptr && operation.rule.audited) {
    then = [log, &operation, &request, caller, respond](const grpc::Status& done,
                                                        const Message& response) {
      log->note(caller, operation.rule.action, audit_target(request, response), done,
                audit_detail(request));
      respond(done, response);
    };
  }
  if (operation.rule.steers_job) {
    const grpc::Status allowed = may_steer(at.controller, caller, job_of(request));
    if (!allowed.ok()) return then(allowed, handle.response());
  }
  handle.run(at, request, caller, !operation.rule.audited, then);
}

}  // namespace hyades::coordinator
