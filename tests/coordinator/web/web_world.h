#pragma once

#include <memory>
#include <string>

#include "coordinator/web/web_server.h"
#include "core/base/hash.h"
#include "farm/json_form.h"
#include "tests/coordinator/services/farm_world.h"
#include "tests/coordinator/web/http_client.h"

namespace hyades::coordinator {

/// A coordinator with its HTTP server, in this process.
class WebWorld {
 public:
  WebWorld() = default;
  ~WebWorld() { stop(); }

  void start(const std::string& address = "127.0.0.1:0") {
    farm.start();
    farm::Listen listen = farm.how;
    listen.address = address;
    auto started = WebServer::start(listen, *farm.controller, *farm.authority, names);
    ASSERT_TRUE(started.ok()) << (started ? "" : started.error().message);
    web = std::move(*started);
    client = std::make_unique<HttpClient>(web->url());
  }
  void stop() {
    if (farm.controller) farm.controller->stop();
    web.reset();
    farm.stop();
  }

  /// What GET answers, where it answers with JSON.
  farm::Json json(const std::string& target) const {
    const HttpClient::Response response = client->get(target);
    EXPECT_EQ(response.status, 200) << target << ": " << response.body;
    return farm::Json::parse(response.body, nullptr, false);
  }

  /// Uploads a file; its digest.
  std::string upload(const std::string& text) const {
    const std::string digest = core::to_hex(core::sha256(text));
    const HttpClient::Response response = client->send(
        "PUT", "/api/v1/assets/" + digest + "?size=" + std::to_string(text.size()), text);
    EXPECT_EQ(response.status, 200) << response.body;
    return digest;
  }

  /// A submission of the world's small job.
  static farm::Json submission(const std::string& document) {
    return {{"name", "balls"},
            {"document", "job.yaml"},
            {"owner", "ada"},
            {"files",
             {{{"path", "job.yaml"},
               {"sha256", core::to_hex(core::sha256(document))},
               {"size", document.size()}}}}};
  }

  FarmWorld farm;
  std::vector<std::string> names;  ///< by which browsers may come; before start()
  std::unique_ptr<WebServer> web;
  std::unique_ptr<HttpClient> client;
};

}  // namespace hyades::coordinator
