#include "coordinator/access/rules.h"

#include <map>

#include <fmt/format.h>

#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

constexpr v1::Role kAll = v1::ROLE_UNSPECIFIED;
constexpr v1::Role kViewer = v1::ROLE_VIEWER;
constexpr v1::Role kSubmitter = v1::ROLE_SUBMITTER;
constexpr v1::Role kOperator = v1::ROLE_OPERATOR;
constexpr v1::Role kAdmin = v1::ROLE_ADMIN;

const std::vector<Rule>& rules() {
  static const std::vector<Rule> table = {
      // What tells nothing about the farm's work, and a sign-in.
      {"page", kAll, true, false, "", {"GET /", "GET /openapi.yaml", "GET /dashboard/{path...}"}},
      {"health", kAll, true, false, "", {"GET /healthz", "GET /readyz"}},
      {"session", kAll, true, false, "", {"POST /api/v1/session", "DELETE /api/v1/session"}},
      // To look.
      {"whoami", kViewer, true, false, "Admin/WhoAmI", {"GET /api/v1/session"}},
      {"farm.info", kViewer, true, false, "Farm/Info", {"GET /api/v1/info"}},
      {"farm.workers", kViewer, false, false, "Farm/Workers", {"GET /api/v1/workers"}},
      {"farm.events", kViewer, false, false, "", {"GET /api/v1/events"}},
      {"farm.metrics", kViewer, false, false, "", {"GET /metrics"}},
      {"job.list", kViewer, false, false, "Jobs/List", {"GET /api/v1/jobs"}},
      {"job.get",
       kViewer,
       false,
       false,
       "Jobs/Get",
       {"GET /api/v1/jobs/{job}", "GET /api/v1/jobs/{job}/frames"}},
      {"job.watch", kViewer, false, false, "Jobs/Watch", {"GET /api/v1/jobs/{job}/events"}},
      {"job.explain", kViewer, false, false, "Jobs/Explain", {"GET /api/v1/jobs/{job}/explain"}},
      {"job.logs", kViewer, false, false, "Jobs/Logs", {"GET /api/v1/jobs/{job}/logs"}},
      {"job.timeline",
       kViewer,
       false,
       false,
       "Jobs/ListTimeline",
       {"GET /api/v1/jobs/{job}/timeline"}},
      {"job.document", kViewer, false, false, "", {"GET /api/v1/jobs/{job}/document"}},
      {"job.outputs",
       kViewer,
       false,
       false,
       "Jobs/Outputs",
       {"GET /api/v1/jobs/{job}/outputs", "GET /api/v1/jobs/{job}/videos"}},
      {"job.fetch",
       kViewer,
       false,
       false,
       "Jobs/Fetch",
       {"GET /api/v1/jobs/{job}/outputs/{path...}", "GET /api/v1/jobs/{job}/archive.zip"}},
      {"job.film",
       kViewer,
       false,
       false,
       "Jobs/Film",
       {"GET /api/v1/jobs/{job}/frames/{frame}/picture"}},
      // To render. Who holds a file's SHA-256 has had it, or its job.
      {"file.download", kViewer, true, false, "Assets/Download", {}},
      {"worker.attend", kAdmin, true, false, "Work/Attend", {}},
      // To submit, and to steer what one has submitted (allow_steering).
      {"file.find",
       kSubmitter,
       false,
       false,
       "Assets/FindMissing",
       {"POST /api/v1/assets/missing"}},
      {"file.upload", kSubmitter, false, false, "Assets/Upload", {"PUT /api/v1/assets/{sha256}"}},
      {"job.submit", kSubmitter, false, true, "Jobs/Submit", {"POST /api/v1/jobs"}},
      {"job.pause", kSubmitter, false, true, "Jobs/Pause", {"POST /api/v1/jobs/{job}/pause"}},
      {"job.resume", kSubmitter, false, true, "Jobs/Resume", {"POST /api/v1/jobs/{job}/resume"}},
      {"job.cancel", kSubmitter, false, true, "Jobs/Cancel", {"POST /api/v1/jobs/{job}/cancel"}},
      {"job.retry", kSubmitter, false, true, "Jobs/Retry", {"POST /api/v1/jobs/{job}/retry"}},
      {"job.priority",
       kSubmitter,
       false,
       true,
       "Jobs/SetPriority",
       {"PUT /api/v1/jobs/{job}/priority"}},
      {"job.video", kSubmitter, false, true, "", {"POST /api/v1/jobs/{job}/videos"}},
      {"job.delete", kSubmitter, false, true, "Jobs/Delete", {"DELETE /api/v1/jobs/{job}"}},
      // To run the farm.
      {"worker.drain",
       kOperator,
       false,
       true,
       "Farm/DrainWorker",
       {"POST /api/v1/workers/{worker}/drain"}},
      {"worker.quarantine",
       kOperator,
       false,
       true,
       "Farm/QuarantineWorker",
       {"POST /api/v1/workers/{worker}/quarantine"}},
      {"worker.release",
       kOperator,
       false,
       true,
       "Farm/ReleaseWorker",
       {"POST /api/v1/workers/{worker}/release"}},
      {"token.create", kAdmin, false, true, "Admin/CreateToken", {}},
      {"token.list", kAdmin, false, false, "Admin/ListTokens", {}},
      {"token.revoke", kAdmin, false, true, "Admin/RevokeToken", {}},
      {"audit.read", kAdmin, false, false, "Admin/Audit", {}},
  };
  return table;
}

const Rule& what_has_none() {
  static const Rule rule = {"unknown", kAdmin, false, true, "", {}};
  return rule;
}

}  // namespace

std::span<const Rule> all_rules() { return rules(); }

const Rule& rule_of_method(std::string_view method) {
  static const auto by_method = [] {
    std::map<std::string_view, const Rule*> all;
    for (const Rule& rule : rules()) all[rule.method] = &rule;
    all.erase("");
    return all;
  }();
  const auto found = by_method.find(method);
  return found == by_method.end() ? what_has_none() : *found->second;
}

const Rule& rule_of_route(std::string_view route) {
  // Files of the dashboard have a route each.
  if (route.starts_with("GET /dashboard/")) return rules().front();
  for (const Rule& rule : rules()) {
    for (const char* known : rule.routes) {
      if (route == known) return rule;
    }
  }
  return what_has_none();
}

bool may(v1::Role role, const Rule& rule) {
  if (rule.least == kAll || role == kAdmin) return true;
  if (role == v1::ROLE_WORKER) return rule.worker;
  return role != v1::ROLE_UNSPECIFIED && role >= rule.least;
}

grpc::Status allow(const Caller& caller, const Rule& rule) {
  if (may(caller.role, rule)) return grpc::Status::OK;
  const bool render = rule.worker && rule.least == kAdmin;
  const std::string needed = role_name(render ? v1::ROLE_WORKER : rule.least);
  return {
      grpc::StatusCode::PERMISSION_DENIED,
      fmt::format("{} needs the role {}, and this token ({} of {}) has the role {}: an admin "
                  "makes another with 'hyades token create --role {} --name NAME'",
                  rule.deed, needed, caller.token_id, caller.name, role_name(caller.role), needed)};
}

grpc::Status allow_steering(const Caller& caller, uint64_t job, const std::string& owner,
                            bool proven) {
  const bool his = proven && caller.name == owner;
  if (caller.role == kAdmin || caller.role == kOperator || his) return grpc::Status::OK;
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

std::string role_name(v1::Role role) { return farm::role_name(role); }

}  // namespace hyades::coordinator
