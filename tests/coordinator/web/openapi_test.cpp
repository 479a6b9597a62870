// openapi.yaml says what the server does: every path of it is answered, nothing else is, and
// answers have the form that it gives them.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include <yaml-cpp/yaml.h>

#include "coordinator/operations/operation.h"
#include "tests/coordinator/services/troubled_store.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

class OpenApi : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    const auto page = world.client->get("/openapi.yaml");
    ASSERT_EQ(page.status, 200);
    api = YAML::Load(page.body);
  }

  YAML::Node schema_of(const std::string& name) const { return api["components"]["schemas"][name]; }

  YAML::Node resolve(const YAML::Node& schema) const {
    if (!schema["$ref"]) return schema;
    const auto reference = schema["$ref"].as<std::string>();
    return schema_of(reference.substr(reference.rfind('/') + 1));
  }

  /// Whether `value` is as `said` has it; no field that is not named there.
  void expect_form(const Json& value, const YAML::Node& said, const std::string& where) const {
    const YAML::Node schema = resolve(said);
    const auto type = schema["type"].as<std::string>();
    if (schema["x-part-of"]) {
      ASSERT_TRUE(value.contains("id")) << where;
      const YAML::Node whole = schema_of(schema["x-part-of"].as<std::string>());
      for (const auto& [name, field] : value.items()) {
        if (!field.is_null()) expect_form(field, whole["properties"][name], where + "." + name);
      }
    } else if (type == "object") {
      ASSERT_TRUE(value.is_object()) << where;
      for (const YAML::Node& needed : schema["required"]) {
        EXPECT_TRUE(value.contains(needed.as<std::string>()))
            << where << " lacks " << needed.as<std::string>();
      }
      for (const auto& [name, field] : value.items()) {
        const YAML::Node of_field = schema["properties"][name];
        ASSERT_TRUE(of_field.IsDefined()) << where << "." << name << " is not told of";
        expect_form(field, of_field, where + "." + name);
      }
    } else if (type == "array") {
      ASSERT_TRUE(value.is_array()) << where;
      for (const Json& item : value) expect_form(item, schema["items"], where + "[]");
    } else if (type == "string") {
      ASSERT_TRUE(value.is_string()) << where;
      if (!schema["enum"]) return;
      const auto text = value.get<std::string>();
      bool known = false;
      for (const YAML::Node& one : schema["enum"]) known |= one.as<std::string>() == text;
      EXPECT_TRUE(known) << where << ": " << value;
    } else if (type == "integer") {
      EXPECT_TRUE(value.is_number_integer()) << where << ": " << value;
    } else if (type == "number") {
      EXPECT_TRUE(value.is_number()) << where << ": " << value;
    } else {
      EXPECT_EQ(type, "boolean");
      EXPECT_TRUE(value.is_boolean()) << where << ": " << value;
    }
  }

  static void expect_media_type(const HttpClient::Response& response, const YAML::Node& told,
                                const std::string& where) {
    const auto header = response.headers.find("content-type");
    ASSERT_NE(header, response.headers.end()) << where;
    const std::string type = header->second.substr(0, header->second.find(';'));
    EXPECT_TRUE(told["content"][type].IsDefined() || told["content"]["*/*"].IsDefined())
        << where << ": " << header->second;
  }

  /// That an answer has a media type which the description gives; what it was.
  std::string media_type(const std::string& path, const std::string& target,
                         const HttpClient::Headers& headers = {}) const {
    const auto response = world.client->get(target, headers);
    const YAML::Node told = api["paths"][path]["get"]["responses"][std::to_string(response.status)];
    EXPECT_TRUE(told.IsDefined()) << target << ": " << response.status << " " << response.body;
    if (!told.IsDefined()) return {};
    expect_media_type(response, told, target);
    return response.headers.at("content-type");
  }

  /// Values that a parameter of this schema may not have.
  static std::vector<std::string> wrong_values(const YAML::Node& schema) {
    std::vector<std::string> wrong;
    const auto type = schema["type"].as<std::string>();
    if (type == "integer") {
      wrong = {"many", "1.5", "99999999999999999999"};
      if (schema["minimum"]) wrong.push_back(std::to_string(schema["minimum"].as<int64_t>() - 1));
      if (schema["maximum"]) wrong.push_back(std::to_string(schema["maximum"].as<int64_t>() + 1));
    }
    if (schema["enum"]) wrong.emplace_back("nonsense");
    if (type == "boolean") wrong.emplace_back("perhaps");
    return wrong;
  }

  /// What the description says of a call's answer.
  void expect_as_told(const std::string& method, const std::string& path, const std::string& target,
                      const std::string& body = {}) const {
    const auto response = world.client->send(method, target, body);
    ASSERT_LT(response.status, 300) << method << " " << target << ": " << response.body;
    std::string small = method;
    std::transform(small.begin(), small.end(), small.begin(), ::tolower);
    const YAML::Node told = api["paths"][path][small]["responses"][std::to_string(response.status)];
    ASSERT_TRUE(told.IsDefined()) << method << " " << path << " gives " << response.status;
    if (response.status == 204) return;
    expect_media_type(response, told, method + " " + target);
    const YAML::Node content = told["content"]["application/json"];
    ASSERT_TRUE(content.IsDefined()) << method << " " << path;
    expect_form(Json::parse(response.body), content["schema"], method + " " + path);
  }

  WebWorld world;
  YAML::Node api;
};

TEST_F(OpenApi, EveryPathIsAnsweredAndEveryRouteIsTold) {
  std::set<std::string> told;
  for (const auto& path : api["paths"]) {
    for (const auto& method : path.second) {
      auto name = method.first.as<std::string>();
      if (name == "parameters") continue;
      std::transform(name.begin(), name.end(), name.begin(), ::toupper);
      const auto text = path.first.as<std::string>();
      const size_t action = text.find("{action}");
      if (action == std::string::npos) {
        told.insert(name + " " + text);
        continue;
      }
      for (const YAML::Node& parameter : path.second["parameters"]) {
        if (!parameter["schema"] || !parameter["schema"]["enum"]) continue;
        for (const YAML::Node& one : parameter["schema"]["enum"]) {
          told.insert(name + " " + text.substr(0, action) + one.as<std::string>());
        }
      }
    }
  }
  std::set<std::string> answered;
  for (const std::string& route : world.web->routes()) {
    const bool page = route.find(" /api/") == std::string::npos && route != "GET /metrics" &&
                      route != "GET /healthz" && route != "GET /readyz";
    if (!page) answered.insert(std::regex_replace(route, std::regex("\\.\\.\\.\\}"), "}"));
  }
  EXPECT_EQ(told, answered);
}

TEST_F(OpenApi, WhatItSaysOfQueriesIsRead) {
  int tried = 0;
  for (const auto& path : api["paths"]) {
    std::string target = path.first.as<std::string>();
    for (const char* name : {"{job}", "{frame}"}) {
      const size_t at = target.find(name);
      if (at != std::string::npos) target.replace(at, std::string(name).size(), "1");
    }
    const YAML::Node get = path.second["get"];
    if (!get || !get["parameters"]) continue;
    for (const YAML::Node& parameter : get["parameters"]) {
      const YAML::Node schema = parameter["schema"];
      if (!schema || (schema["type"].as<std::string>() != "integer" && !schema["enum"])) continue;
      ++tried;
      const std::string asked = target + "?" + parameter["name"].as<std::string>() + "=nonsense";
      EXPECT_EQ(world.client->get(asked).status, 400) << asked;
    }
  }
  EXPECT_GE(tried, 13);
}

TEST_F(OpenApi, AnswersHaveTheFormThatItGives) {
  const uint64_t job = world.farm.submit(2);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const std::string one = "/api/v1/jobs/" + std::to_string(job);
  expect_as_told("GET", "/api/v1/info", "/api/v1/info");
  expect_as_told("GET", "/api/v1/session", "/api/v1/session");
  expect_as_told("GET", "/api/v1/jobs", "/api/v1/jobs?ended=true");
  expect_as_told("GET", "/api/v1/jobs/{job}", one);
  expect_as_told("GET", "/api/v1/jobs/{job}/logs", one + "/logs");
  expect_as_told("GET", "/api/v1/jobs/{job}/outputs", one + "/outputs");
  expect_as_told("GET", "/api/v1/jobs/{job}/explain", one + "/explain");
  expect_as_told("POST", "/api/v1/jobs/{job}/videos", one + "/videos", R"({"rate": 12})");
  expect_as_told("GET", "/api/v1/jobs/{job}/videos", one + "/videos");
  expect_as_told("GET", "/api/v1/jobs/{job}/timeline", one + "/timeline");
  expect_as_told("GET", "/api/v1/jobs/{job}/frames", one + "/frames?state=done");
  EXPECT_EQ(world.json(one + "/frames?state=done")["frames"].size(), 2U);
  EXPECT_EQ(world.json(one + "/frames?state=failed")["frames"].size(), 0U);
  EXPECT_EQ(world.client->get(one + "/frames?state=asleep").status, 400);
  const Json timeline = world.json(one + "/timeline");
  EXPECT_FALSE(timeline["steps"].empty());
  EXPECT_TRUE(world.json(one + "/timeline?after=" + timeline["after"].dump())["units"].empty());
  const Json first = world.json(one + "/timeline?limit=1");
  EXPECT_EQ(first["units"].size() + first["steps"].size(), 1U);
  EXPECT_EQ(first["more"], true);
  expect_as_told("GET", "/api/v1/workers", "/api/v1/workers");
  const Json workers = world.json("/api/v1/workers")["workers"];
  ASSERT_FALSE(workers.empty());
  expect_as_told("POST", "/api/v1/workers/{worker}/{action}",
                 "/api/v1/workers/" + workers[0]["id"].dump() + "/quarantine",
                 R"({"reason": "odd"})");
  const std::string document = FarmWorld::document(5);
  const std::string digest = core::to_hex(core::sha256(document));
  expect_as_told("POST", "/api/v1/assets/missing", "/api/v1/assets/missing",
                 Json({{"files", WebWorld::submission(document)["files"]}}).dump());
  expect_as_told("PUT", "/api/v1/assets/{sha256}",
                 "/api/v1/assets/" + digest + "?size=" + std::to_string(document.size()), document);
  expect_as_told("POST", "/api/v1/jobs", "/api/v1/jobs", WebWorld::submission(document).dump());
  const std::string next = "/api/v1/jobs/" + std::to_string(job + 1);
  expect_as_told("POST", "/api/v1/jobs/{job}/{action}", next + "/pause");
  expect_as_told("PUT", "/api/v1/jobs/{job}/priority", next + "/priority", R"({"priority": 3})");
  expect_as_told("DELETE", "/api/v1/jobs/{job}", one);
  const auto wrong = world.client->get("/api/v1/jobs/999");
  expect_form(Json::parse(wrong.body), schema_of("Error"), "Error");
}

TEST_F(OpenApi, AnswersHaveTheMediaTypesThatItGives) {
  const uint64_t job = world.farm.submit(1);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const std::string one = "/api/v1/jobs/" + std::to_string(job);
  media_type("/api/v1/jobs/{job}/document", one + "/document");
  media_type("/api/v1/jobs/{job}/archive.zip", one + "/archive.zip");
  const std::string file = world.json(one + "/outputs")["outputs"][0]["id"];
  media_type("/api/v1/jobs/{job}/outputs/{path}", one + "/outputs/" + file);
  media_type("/api/v1/jobs/{job}/outputs/{path}", one + "/outputs/" + file,
             {{"Range", "bytes=0-3"}});
  media_type("/api/v1/jobs/{job}/frames/{frame}/picture", one + "/frames/1/picture");
  for (const char* path : {"/healthz", "/readyz", "/metrics"}) media_type(path, path);
  HttpClient::Events events(*world.client, "/api/v1/events");
  EXPECT_EQ(events.status(), 200);
}

TEST_F(OpenApi, TellsThatWhatCannotBeStoredIsAnsweredLater) {
  world.stop();
  const auto trouble = std::make_shared<Trouble>();
  world.farm.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  world.start();
  const std::string job = std::to_string(world.farm.submit(1));
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(eventually([&] { return worker.streams() == 1; }));
  trouble->of_writes(Trouble::Kind::fails);
  const auto expect_told = [&](const std::string& method, const std::string& path,
                               const std::string& target, const std::string& body = {}) {
    const auto response = world.client->send(method, "/api/v1/" + target, body);
    EXPECT_EQ(response.status, 503) << target << ": " << response.body;
    EXPECT_TRUE(
        api["paths"]["/api/v1/" + path][method == "PUT" ? "put" : "post"]["responses"]["503"]
            .IsDefined())
        << path;
    expect_form(Json::parse(response.body), schema_of("Error"), target);
  };
  expect_told("POST", "jobs/{job}/{action}", "jobs/" + job + "/pause");
  expect_told("POST", "jobs/{job}/{action}", "jobs/" + job + "/retry");
  expect_told("PUT", "jobs/{job}/priority", "jobs/" + job + "/priority", R"({"priority": 3})");
  expect_told("POST", "workers/{worker}/{action}", "workers/1/quarantine", "{}");
  expect_told("POST", "workers/{worker}/{action}", "workers/1/release", "{}");
  trouble->of_writes(Trouble::Kind::none);
}

// A value that a parameter may not have is refused: so it is read, and as it is told.
TEST_F(OpenApi, ParametersAreTakenAsItTells) {
  const uint64_t job = world.farm.submit(1);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  int tried = 0;
  for (const auto& path : api["paths"]) {
    std::string target = path.first.as<std::string>();
    for (const auto& [name, value] :
         {std::pair("{job}", std::to_string(job)), std::pair("{frame}", std::string("1")),
          std::pair("{sha256}", std::string(64, 'a'))}) {
      if (const size_t at = target.find(name); at != std::string::npos) {
        target.replace(at, std::string(name).size(), value);
      }
    }
    for (const auto& method : path.second) {
      auto verb = method.first.as<std::string>();
      std::transform(verb.begin(), verb.end(), verb.begin(), ::toupper);
      for (const YAML::Node& parameter : method.second["parameters"]) {
        const auto name = parameter["name"].as<std::string>();
        const std::string needed = name != "size" && verb == "PUT" ? "&size=5" : "";
        for (const std::string& wrong : wrong_values(parameter["schema"])) {
          const std::string asked = target + "?" + name + "=" + wrong + needed;
          EXPECT_EQ(world.client->send(verb, asked, verb == "PUT" ? "x" : "").status, 400) << asked;
          ++tried;
        }
      }
    }
  }
  EXPECT_GT(tried, 30);
}

// What stands in the path, too; the body of a request is JSON where it says so.
TEST_F(OpenApi, PathsAndBodiesAreTakenAsItTells) {
  const uint64_t job = world.farm.submit(1);
  const std::string one = "/api/v1/jobs/" + std::to_string(job);
  for (const char* wrong : {"seven", "-1", "0", "1.5", "99999999999999999999"}) {
    EXPECT_EQ(world.client->get(std::string("/api/v1/jobs/") + wrong).status, 404) << wrong;
  }
  EXPECT_EQ(world.client->get(one + "/frames/first/picture").status, 404);
  int bodies = 0;
  for (const auto& path : api["paths"]) {
    for (const auto& method : path.second) {
      if (!method.second.IsMap()) continue;
      const YAML::Node body = method.second["requestBody"];
      if (!body.IsDefined() || !body["content"]["application/json"]) continue;
      std::string target = path.first.as<std::string>();
      for (const auto& [name, value] :
           {std::pair("{job}", std::to_string(job)), std::pair("{worker}", std::string("1")),
            std::pair("{action}", std::string("drain"))}) {
        if (const size_t at = target.find(name); at != std::string::npos) {
          target.replace(at, std::string(name).size(), value);
        }
      }
      auto verb = method.first.as<std::string>();
      std::transform(verb.begin(), verb.end(), verb.begin(), ::toupper);
      const int status = world.client->send(verb, target, "{nonsense").status;
      EXPECT_TRUE(status == 400 || status == 401) << verb << " " << target << " " << status;
      ++bodies;
    }
  }
  EXPECT_GE(bodies, 5);
}

// The other way round: no parameter is read that is not told of.
TEST_F(OpenApi, EveryParameterThatIsReadIsTold) {
  std::set<std::string> told;
  for (const auto& path : api["paths"]) {
    for (const auto& method : path.second) {
      if (!method.second.IsMap()) continue;
      for (const YAML::Node& parameter : method.second["parameters"]) {
        if (parameter["in"] && parameter["in"].as<std::string>() == "query") {
          told.insert(parameter["name"].as<std::string>());
        }
      }
    }
  }
  std::set<std::string> read;
  for (const Operation& operation : all_operations()) {
    for (const Route& route : operation.routes) {
      for (const QueryField& field : route.query) read.insert(field.name);
    }
  }
  EXPECT_EQ(told, read);
}

// What the table has of a route is what is told of it.
TEST_F(OpenApi, QueriesAreThoseOfTheTable) {
  int compared = 0;
  for (const Operation& operation : all_operations()) {
    for (const Route& route : operation.routes) {
      const std::string path =
          std::regex_replace(std::string(route.path), std::regex("\\.\\.\\.\\}"), "}");
      if (!path.starts_with("GET ")) continue;
      const YAML::Node get = api["paths"][path.substr(4)]["get"];
      if (route.query.empty() || !get.IsDefined()) continue;
      ASSERT_EQ(get["parameters"].size(), route.query.size()) << path;
      for (size_t i = 0; i < route.query.size(); ++i) {
        const YAML::Node told = get["parameters"][i];
        EXPECT_EQ(told["name"].as<std::string>(), route.query[i].name) << path;
        const bool bounded = route.query[i].least != INT64_MIN;
        EXPECT_EQ(told["schema"]["minimum"].IsDefined(), bounded) << path;
        if (bounded) {
          EXPECT_EQ(told["schema"]["minimum"].as<int64_t>(), route.query[i].least);
        }
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 18);
}

// The fields of a message are the properties of its schema.
TEST_F(OpenApi, SchemasAreThoseOfTheMessages) {
  for (const auto* type : {v1::Job::descriptor(), v1::Frame::descriptor(), v1::Worker::descriptor(),
                           v1::InfoResponse::descriptor(), v1::Video::descriptor()}) {
    const std::string name = type->name() == "InfoResponse" ? "Info" : type->name();
    std::set<std::string> told;
    for (const auto& property : schema_of(name)["properties"]) {
      told.insert(property.first.as<std::string>());
    }
    std::set<std::string> fields;
    for (int i = 0; i < type->field_count(); ++i) fields.insert(farm::json_name(*type->field(i)));
    EXPECT_EQ(told, fields) << name;
  }
}

TEST_F(OpenApi, EventsHaveTheFormThatItGives) {
  const uint64_t job = world.farm.submit(2);
  HttpClient::Events of_farm(*world.client, "/api/v1/events");
  expect_form(Json::parse(of_farm.next().data), schema_of("FarmSnapshot"), "FarmSnapshot");
  HttpClient::Events of_job(*world.client, "/api/v1/jobs/" + std::to_string(job) + "/events");
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  for (auto event = of_job.next(); !event.name.empty(); event = of_job.next()) {
    expect_form(Json::parse(event.data), schema_of("JobChange"), event.name);
  }
  expect_form(Json::parse(of_farm.next().data), schema_of("FarmChange"), "FarmChange");
}

}  // namespace
}  // namespace hyades::coordinator
