// One table says what the coordinator can be asked for, and by whom; nothing is missing in it.
#include "coordinator/operations/operation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include <google/protobuf/descriptor.h>
#include <yaml-cpp/yaml.h>

#include "hyades/v1/admin.pb.h"
#include "hyades/v1/assets.pb.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {
namespace {

TEST(Rules, EveryMethodOfTheWireHasOne) {
  std::set<std::string> known;
  for (const Operation& row : all_operations()) {
    if (*row.method != '\0') {
      EXPECT_TRUE(known.insert(row.method).second) << row.method << " stands twice";
    }
  }
  std::set<std::string> methods;
  for (const auto* file : {v1::Token::descriptor()->file(), v1::UploadPart::descriptor()->file(),
                           v1::Worker::descriptor()->file(), v1::Job::descriptor()->file(),
                           v1::Hello::descriptor()->file()}) {
    ASSERT_GT(file->service_count(), 0) << file->name();
    for (int s = 0; s < file->service_count(); ++s) {
      for (int m = 0; m < file->service(s)->method_count(); ++m) {
        methods.insert(file->service(s)->name() + "/" + file->service(s)->method(m)->name());
      }
    }
  }
  EXPECT_EQ(known, methods);
}

/// Those that one message answers.
std::vector<const google::protobuf::MethodDescriptor*> unary_methods() {
  std::vector<const google::protobuf::MethodDescriptor*> all;
  for (const auto* file : {v1::Token::descriptor()->file(), v1::UploadPart::descriptor()->file(),
                           v1::Worker::descriptor()->file(), v1::Job::descriptor()->file()}) {
    for (int m = 0; m < file->service(0)->method_count(); ++m) {
      const auto* method = file->service(0)->method(m);
      if (!method->client_streaming() && !method->server_streaming()) all.push_back(method);
    }
  }
  return all;
}

TEST(Operations, HandlersTakeAndGiveWhatTheWireSays) {
  for (const auto* method : unary_methods()) {
    const Operation& row = operation_of_method(method->service()->name() + "/" + method->name());
    ASSERT_TRUE(row.handle) << method->full_name();
    EXPECT_EQ(row.handle.request().GetDescriptor(), method->input_type()) << method->full_name();
    EXPECT_EQ(row.handle.response().GetDescriptor(), method->output_type()) << method->full_name();
  }
  EXPECT_EQ(unary_methods().size(), 21U);
}

TEST(Operations, WhatRoutesTakeIsInTheirRequests) {
  for (const Operation& row : all_operations()) {
    for (const Route& route : row.routes) {
      if (!row.handle) continue;
      const auto* type = (route.handle ? route.handle : row.handle).request().GetDescriptor();
      for (const QueryField& field : route.query) {
        EXPECT_NE(type->FindFieldByName(field.name), nullptr) << route.path << " " << field.name;
      }
      const std::string path = route.path;
      for (size_t at = path.find('{'); at != std::string::npos; at = path.find('{', at + 1)) {
        const std::string name = path.substr(at + 1, path.find('}', at) - at - 1);
        EXPECT_NE(type->FindFieldByName(name), nullptr) << route.path;
      }
    }
  }
}

TEST(Operations, OnlyThoseWhoMayWaitLookWhoseJobItIs) {
  for (const Operation& row : all_operations()) {
    if (!row.rule.steers_job) continue;
    EXPECT_NE(row.runs, Runs::at_once) << row.rule.action;
    EXPECT_TRUE(row.rule.audited) << row.rule.action;
    EXPECT_NE(row.handle.request().GetDescriptor()->FindFieldByName("job"), nullptr);
  }
}

TEST(Operations, StreamsSayWhereTheyWaitForTheDisk) {
  // What is held in memory, and streams that are written on other threads as things happen.
  const std::set<std::string> at_once = {"Work/Attend", "page", "health", "farm.events", "session"};
  for (const Operation& row : all_operations()) {
    if (row.handle || row.runs != Runs::at_once) continue;
    EXPECT_TRUE(at_once.contains(row.method) || at_once.contains(row.rule.action))
        << row.rule.action << " " << row.method;
  }
}

/// What is answered from memory is not looked at again.
TEST(Operations, OnlyWhatEverybodyMayKnowIsAnsweredFromMemory) {
  for (const Operation& row : all_operations()) {
    if (!row.handle || !row.handle.has_memory()) continue;
    EXPECT_FALSE(row.rule.steers_job) << row.rule.action;
    EXPECT_FALSE(row.rule.audited) << row.rule.action;
  }
}

TEST(Rules, EveryPathOfOpenApiHasOne) {
  const YAML::Node api = YAML::LoadFile("coordinator/web/api/openapi.yaml");
  int count = 0;
  for (const auto& path : api["paths"]) {
    std::string pattern = path.first.as<std::string>();
    std::vector<std::string> patterns = {pattern};
    const size_t action = pattern.find("{action}");
    if (action != std::string::npos) {
      patterns.clear();
      for (const YAML::Node& parameter : path.second["parameters"]) {
        if (!parameter["schema"] || !parameter["schema"]["enum"]) continue;
        for (const YAML::Node& one : parameter["schema"]["enum"]) {
          patterns.push_back(pattern.substr(0, action) + one.as<std::string>());
        }
      }
    }
    for (std::string one : patterns) {
      if (one.ends_with("{path}")) one.insert(one.size() - 1, "...");
      for (const auto& method : path.second) {
        auto name = method.first.as<std::string>();
        if (name == "parameters") continue;
        std::transform(name.begin(), name.end(), name.begin(), ::toupper);
        EXPECT_STRNE(operation_of_route(name + " " + one).rule.action, "unknown")
            << name << " " << one;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 25);
}

TEST(Rules, WhatHasNoneIsForAdmins) {
  for (const Rule* rule : {&operation_of_method("Jobs/Explode").rule,
                           &operation_of_route("GET /api/v1/secrets").rule}) {
    EXPECT_FALSE(may(v1::ROLE_OPERATOR, *rule));
    EXPECT_FALSE(may(v1::ROLE_WORKER, *rule));
    EXPECT_FALSE(may(v1::ROLE_UNSPECIFIED, *rule));
    EXPECT_TRUE(may(v1::ROLE_ADMIN, *rule));
  }
}

TEST(Rules, EachRoleMayWhatThoseBelowMay) {
  for (const Operation& row : all_operations()) {
    const Rule& rule = row.rule;
    EXPECT_LE(may(v1::ROLE_VIEWER, rule), may(v1::ROLE_SUBMITTER, rule)) << rule.action;
    EXPECT_LE(may(v1::ROLE_SUBMITTER, rule), may(v1::ROLE_OPERATOR, rule)) << rule.action;
    EXPECT_LE(may(v1::ROLE_OPERATOR, rule), may(v1::ROLE_ADMIN, rule)) << rule.action;
  }
  const auto allowed = [](v1::Role role, const char* method) {
    return may(role, operation_of_method(method).rule);
  };
  EXPECT_TRUE(allowed(v1::ROLE_VIEWER, "Jobs/Watch"));
  EXPECT_FALSE(allowed(v1::ROLE_VIEWER, "Jobs/Cancel"));
  EXPECT_FALSE(allowed(v1::ROLE_VIEWER, "Assets/Upload"));
  EXPECT_TRUE(allowed(v1::ROLE_SUBMITTER, "Jobs/Submit"));
  EXPECT_FALSE(allowed(v1::ROLE_SUBMITTER, "Farm/DrainWorker"));
  EXPECT_FALSE(allowed(v1::ROLE_OPERATOR, "Admin/CreateToken"));
  EXPECT_FALSE(allowed(v1::ROLE_OPERATOR, "Work/Attend"));
  EXPECT_TRUE(allowed(v1::ROLE_WORKER, "Work/Attend"));
  EXPECT_TRUE(allowed(v1::ROLE_WORKER, "Assets/Download"));
  for (const char* method : {"Jobs/List", "Jobs/Fetch", "Jobs/Submit", "Farm/Workers",
                             "Assets/Upload", "Admin/ListTokens"}) {
    EXPECT_FALSE(allowed(v1::ROLE_WORKER, method)) << method;
  }
}

TEST(Rules, ARefusalSaysWhatIsNeeded) {
  const Caller caller = {"9f3a01c2", "alice", v1::ROLE_VIEWER, "here"};
  const grpc::Status refused = allow(caller, operation_of_method("Jobs/Cancel").rule);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::PERMISSION_DENIED);
  for (const char* part : {"job.cancel", "submitter", "9f3a01c2", "alice", "viewer",
                           "hyades token create --role submitter"}) {
    EXPECT_NE(refused.error_message().find(part), std::string::npos) << refused.error_message();
  }
  const Caller operates = {"9f3a01c2", "bob", v1::ROLE_OPERATOR, "here"};
  EXPECT_NE(
      allow(operates, operation_of_method("Work/Attend").rule).error_message().find("role worker"),
      std::string::npos);
}

TEST(Rules, JobsAreSteeredByTheirOwners) {
  const Caller alice = {"1", "alice", v1::ROLE_SUBMITTER, {}};
  EXPECT_TRUE(allow_steering(alice, 1, "alice", true).ok());
  EXPECT_EQ(allow_steering(alice, 1, "bob", true).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_FALSE(allow_steering(alice, 1, "", false).ok());
  EXPECT_TRUE(allow_steering({"2", "carol", v1::ROLE_OPERATOR, {}}, 1, "bob", false).ok());
}

}  // namespace
}  // namespace hyades::coordinator
