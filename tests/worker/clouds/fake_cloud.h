#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <ctime>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "worker/clouds/cloud.h"

namespace hyades::worker {

/// The metadata service of a cloud, on this machine: strict about headers, as the real ones are.
class FakeCloud {
 public:
  enum class Manner { right, silent, garbage, missing, broken, endless, hangs_up };

  explicit FakeCloud(Cloud cloud) : cloud_(cloud) {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)::bind(listening_, reinterpret_cast<sockaddr*>(&at), sizeof at);
    (void)::listen(listening_, 8);
    socklen_t size = sizeof at;
    ::getsockname(listening_, reinterpret_cast<sockaddr*>(&at), &size);
    port_ = ntohs(at.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeCloud() {
    ::shutdown(listening_, SHUT_RDWR);
    thread_.join();
    ::close(listening_);
    for (const int one : waiting_) ::close(one);
    for (const int one : forgotten_) ::close(one);
  }
  FakeCloud(const FakeCloud&) = delete;
  FakeCloud& operator=(const FakeCloud&) = delete;

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_); }
  void behave(Manner manner) {
    const std::lock_guard lock(mutex_);
    manner_ = manner;
  }
  size_t asked() const {
    const std::lock_guard lock(mutex_);
    return asked_;
  }
  /// From now on the machine goes in so many seconds. `machine`: which one.
  void preempt(int seconds, const std::string& machine = "node_7") {
    const std::lock_guard lock(mutex_);
    gone_at_ = std::time(nullptr) + seconds;
    gone_ = machine;
    for (const int one : waiting_) answer(one, 200, "TRUE", "ETag: b2\r\n");
    waiting_.clear();
  }

  /// Questions of somebody who waits for the change after the last one: they have missed that.
  size_t missed() const {
    const std::lock_guard lock(mutex_);
    return missed_;
  }

 private:
  void serve() {
    for (;;) {
      const int one = ::accept(listening_, nullptr, nullptr);
      if (one < 0) return;
      std::string head;
      char buffer[4096];
      while (head.find("\r\n\r\n") == std::string::npos) {
        const ssize_t count = ::recv(one, buffer, sizeof buffer, 0);
        if (count <= 0) break;
        head.append(buffer, static_cast<size_t>(count));
      }
      const std::lock_guard lock(mutex_);
      ++asked_;
      reply(one, head);
    }
  }

  static void answer(int one, int status, const std::string& body, const std::string& more = "") {
    const std::string reply = "HTTP/1.1 " + std::to_string(status) +
                              " X\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
                              more + "Connection: close\r\n\r\n" + body;
    (void)::send(one, reply.data(), reply.size(), MSG_NOSIGNAL);
    ::close(one);
  }

  void reply(int one, const std::string& head) {
    switch (manner_) {
      case Manner::right:
        break;
      case Manner::silent:
        forgotten_.push_back(one);
        return;
      case Manner::garbage:
        return answer(one, 200, "<html>[[[{\"action\": 7, \"Events\": [3]\x01\xff");
      case Manner::missing:
        return answer(one, 404, "");
      case Manner::broken:
        return answer(one, 500, "TRUE");
      case Manner::endless:
        return answer(one, 200, std::string(1 << 20, '['));
      case Manner::hangs_up:
        ::close(one);
        return;
    }
    const auto asks = [&](const char* start) { return head.starts_with(start); };
    const auto has = [&](const char* line) { return head.find(line) != std::string::npos; };
    if (cloud_ == Cloud::aws) {
      if (asks("PUT /latest/api/token ")) {
        const bool right = has("X-aws-ec2-metadata-token-ttl-seconds: 21600\r\n");
        return answer(one, right ? 200 : 400, right ? "secret-token" : "");
      }
      if (!has("X-aws-ec2-metadata-token: secret-token\r\n")) return answer(one, 401, "");
      if (!asks("GET /latest/meta-data/spot/instance-action ") || gone_at_ == 0) {
        return answer(one, 404, "");
      }
      return answer(one, 200,
                    R"({"action": "terminate", "time": ")" + time("%Y-%m-%dT%H:%M:%SZ") + "\"}");
    }
    if (cloud_ == Cloud::gcp) {
      if (!has("Metadata-Flavor: Google\r\n")) return answer(one, 403, "");
      if (asks("GET /computeMetadata/v1/instance/maintenance-event ")) {
        return answer(one, 200, "NONE");
      }
      if (!asks("GET /computeMetadata/v1/instance/preempted")) return answer(one, 404, "");
      const bool gone = gone_at_ > 0;
      // Who knows the present state waits for the next, also where that state is the last.
      if (has("wait_for_change=true") && has(gone ? "last_etag=b2" : "last_etag=a1")) {
        if (gone) ++missed_;
        waiting_.push_back(one);
        return;
      }
      return gone ? answer(one, 200, "TRUE", "ETag: b2\r\n")
                  : answer(one, 200, "FALSE", "ETag: a1\r\n");
    }
    if (!has("Metadata: true\r\n")) return answer(one, 400, "");
    if (asks("GET /metadata/instance/compute/name?")) return answer(one, 200, "Node_7");
    if (!asks("GET /metadata/scheduledevents?api-version=")) return answer(one, 404, "");
    std::string events = R"({"EventType": "Reboot", "Resources": ["node_7"], "NotBefore": ""},)"
                         R"({"EventType": "Preempt", "Resources": ["node_6"], "NotBefore": ""})";
    if (gone_at_ > 0) {
      events += R"(,{"EventType": "Preempt", "EventStatus": "Scheduled", "Resources": [")" + gone_ +
                R"("], "NotBefore": ")" + time("%a, %d %b %Y %H:%M:%S GMT") + "\"}";
    }
    answer(one, 200, R"({"DocumentIncarnation": 2, "Events": [)" + events + "]}");
  }

  std::string time(const char* format) const {
    std::tm parts{};
    ::gmtime_r(&gone_at_, &parts);
    char text[64];
    (void)std::strftime(text, sizeof text, format, &parts);
    return text;
  }

  const Cloud cloud_;
  int listening_ = -1;
  uint16_t port_ = 0;
  mutable std::mutex mutex_;
  // Guarded by mutex_.
  size_t missed_ = 0;
  Manner manner_ = Manner::right;
  size_t asked_ = 0;
  std::time_t gone_at_ = 0;
  std::string gone_;
  std::vector<int> waiting_;    ///< connections that wait for a change
  std::vector<int> forgotten_;  ///< connections that never hear anything
  std::thread thread_;
};

}  // namespace hyades::worker
