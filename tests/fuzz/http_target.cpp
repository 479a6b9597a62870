// What comes in over HTTP, as bytes of a connection: headers, cookies, targets, ranges, bodies of
// JSON and files. A whole server answers: each answer begins as one does, and none says that
// something inside has gone wrong. What it refuses is taken, too: it has been read.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "coordinator/web/web_server.h"
#include "farm/channel.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_farm.h"

namespace hyades::fuzz {
namespace {

/// A farm that listens, at `port` of this machine.
struct Site {
  Site() {
    farm::Listen listen;
    listen.address = "127.0.0.1:0";
    web = must(coordinator::WebServer::start(listen, *farm.controller, *farm.authority));
    port = std::atoi(web->url().substr(web->url().rfind(':') + 1).c_str());
  }
  ~Site() {
    farm.controller->stop();
    web.reset();
  }
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  Farm farm;
  std::unique_ptr<coordinator::WebServer> web;
  int port = 0;
};

Site& site() {
  static Site one;
  return one;
}

/// What comes back for `bytes`, after which nothing more is sent: the first part, all is read.
std::string exchange(std::string_view bytes) {
  const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{20, 0};
  ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<uint16_t>(site().port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string first;
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) break;
      bytes.remove_prefix(static_cast<size_t>(sent));
    }
    ::shutdown(connection, SHUT_WR);
    std::array<char, 65536> buffer;
    ssize_t count = 0;
    while ((count = ::recv(connection, buffer.data(), buffer.size(), 0)) > 0) {
      if (first.size() < buffer.size()) first.append(buffer.data(), static_cast<size_t>(count));
    }
    if (count < 0 && errno == EAGAIN) {
      std::fprintf(stderr, "the connection stays open\n");
      std::abort();
    }
  }
  ::close(connection);
  return first;
}

std::string request(const std::string& first_line, const std::string& headers = {},
                    const std::string& body = {}) {
  const std::string length =
      body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return first_line + " HTTP/1.1\r\nHost: localhost\r\n" + headers + length + "\r\n" + body;
}

}  // namespace

std::vector<std::string> seeds() {
  const std::string job = "/api/v1/jobs/" + std::to_string(site().farm.job);
  const std::string file = core::to_hex(core::sha256("a file"));
  const std::string document = core::to_hex(core::sha256(Farm::kDocument));
  const std::string submission = R"({"name": "ball", "document": "job.yaml", "owner": "ada",)"
                                 R"( "files": [{"path": "job.yaml", "sha256": ")" +
                                 document + R"(", "size": )" +
                                 std::to_string(Farm::kDocument.size()) +
                                 R"(}], "idempotency_key": "0123456789abcdef"})";
  const std::string missing = R"({"files": [{"sha256": ")" + file + R"(", "size": 6}]})";
  return {request("GET /"),
          request("GET /openapi.yaml", "If-None-Match: \"x\"\r\nAccept-Encoding: gzip\r\n"),
          request("GET /api/v1/jobs?limit=3&ended=1&owner=%61da&before=9"),
          request("GET " + job + "?after=1"),
          request("GET " + job + "/frames?state=waiting&after=1"),
          request("GET " + job + "/logs?after=0", "Connection: keep-alive\r\n") +
              request("HEAD " + job + "/explain"),
          request("GET " + job + "/timeline?limit=5&after=0"),
          request("GET " + job + "/document", "Range: bytes=0-9\r\n"),
          request("GET " + job + "/outputs"),
          request("GET /api/v1/info"),
          request("GET /api/v1/workers"),
          request("GET /metrics"),
          request("GET /healthz"),
          request("GET /api/v1/session",
                  "Cookie: a=b; hyades_session=abc.99.0011\r\nOrigin: http://localhost\r\n"),
          request("GET " + job + "/archive.zip?frames=1-3"),
          request("GET " + job + "/frames/1/picture?layer=beauty&exposure=1.5&as=png"),
          request("GET " + job + "/outputs/ball.0001.exr", "Range: bytes=0-9\r\n"),
          request("GET " + job + "/events", "Last-Event-ID: 3\r\n"),
          request("GET /api/v1/events"),
          request("POST " + job + "/retry", "Transfer-Encoding: chunked\r\n") + "0\r\n\r\n",
          request("POST /api/v1/workers/1/quarantine", "", R"({"reason": "odd"})"),
          request("POST " + job + "/pause"),
          request("POST " + job + "/resume", "Sec-Fetch-Site: same-origin\r\n"),
          request("PUT " + job + "/priority", "", R"({"priority": -3})"),
          request("PUT " + job + "/priority", "", R"({"priority": "high"})"),
          request("POST /api/v1/session", "", R"({"token": ["a"]})"),
          request("POST /api/v1/jobs", "", R"({"name": 1, "document": [], "files": {"a": 1}})"),
          request("POST /api/v1/jobs", "", R"({"name": "a", "document": "b", "files": [1, null]})"),
          request("POST /api/v1/assets/missing", "", R"({"files": [{"sha256": 1, "size": "6"}]})"),
          request("POST /api/v1/jobs", "Content-Type: application/json\r\n", submission),
          request("POST /api/v1/assets/missing", "", missing),
          request("PUT /api/v1/assets/" + file + "?size=6&offset=0", "Expect: 100-continue\r\n",
                  "a file")};
}

bool try_input(std::string_view input) {
  const std::string answer = exchange(input);
  if (answer.empty()) return false;
  if (!answer.starts_with("HTTP/1.")) std::abort();
  if (answer.compare(8, 4, " 500") == 0) {
    std::fprintf(stderr, "%s\n", answer.c_str());
    std::abort();
  }
  return true;
}

}  // namespace hyades::fuzz
