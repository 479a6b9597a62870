#include "coordinator/operations/operation.h"

#include <iterator>
#include <map>
#include <string>

#include "coordinator/operations/ownership.h"

namespace hyades::coordinator {
namespace {

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
  if (operation.rule.steers_job) {
    const grpc::Status his = may_steer(at.controller, caller, job_of(request));
    if (!his.ok()) return respond(his, handle.response());
  }
  handle.run(at, request, caller, !operation.rule.audited, respond);
}

}  // namespace hyades::coordinator
