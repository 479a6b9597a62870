#include "coordinator/access/rules.h"

#include <cstdint>

#include <fmt/format.h>

#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

constexpr v1::Role kAll = v1::ROLE_UNSPECIFIED;
constexpr v1::Role kOperator = v1::ROLE_OPERATOR;
constexpr v1::Role kAdmin = v1::ROLE_ADMIN;

}  // namespace

bool may(v1::Role role, const Rule& rule) {
  if (rule.least == kAll || role == kAdmin) return true;
  if (role == v1::ROLE_WORKER) return rule.worker;
  return role != v1::ROLE_UNSPECIFIED && role >= rule.least;
}

grpc::Status allow(const Caller& caller, const Rule& rule) {
  if (may(caller.role, rule)) return grpc::Status::OK;
  const bool render = rule.worker && rule.least == kAdmin;
  const std::string needed = farm::role_name(render ? v1::ROLE_WORKER : rule.least);
  return {grpc::StatusCode::PERMISSION_DENIED,
          fmt::format("{} needs the role {}, and this token ({} of {}) has the role {}: an admin "
                      "makes another with 'hyades token create --role {} --name NAME'",
                      rule.action, needed, caller.token_id, caller.name,
                      farm::role_name(caller.role), needed)};
}

bool steers_all(const Caller& caller) { return caller.role == kAdmin || caller.role == kOperator; }

grpc::Status allow_steering(const Caller& caller, uint64_t job, const std::string& owner,
                            bool proven) {
  const bool owns = proven && caller.name == owner;
  if (owns || steers_all(caller)) return grpc::Status::OK;
  if (!proven && caller.name == owner) {
    return {grpc::StatusCode::PERMISSION_DENIED,
            fmt::format("job {} was submitted in the name of {} without a token that proves it: "
                        "operators may steer it",
                        job, owner)};
  }
  return {grpc::StatusCode::PERMISSION_DENIED,
          fmt::format("job {} belongs to {}, and this token ({}) to {}: its owner and operators "
                      "may steer it",
                      job, owner.empty() ? "nobody in particular" : owner, caller.token_id,
                      caller.name)};
}

}  // namespace hyades::coordinator
