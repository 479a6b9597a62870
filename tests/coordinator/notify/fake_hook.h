#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hyades::coordinator {

/// Takes what hooks post, on this machine; answers with the status that it is told to.
class FakeHook {
 public:
  FakeHook() {
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
  ~FakeHook() {
    ::shutdown(listening_, SHUT_RDWR);
    thread_.join();
    ::close(listening_);
  }
  FakeHook(const FakeHook&) = delete;
  FakeHook& operator=(const FakeHook&) = delete;

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/secret/path"; }
  void answer_with(std::vector<int> statuses) {
    const std::lock_guard lock(mutex_);
    statuses_ = std::move(statuses);
  }
  /// Where answers of 3xx send whoever asks; of itself where nobody has said.
  void send_to(std::string location) {
    const std::lock_guard lock(mutex_);
    location_ = std::move(location);
  }
  uint16_t port() const { return port_; }
  std::vector<std::string> bodies() const {
    const std::lock_guard lock(mutex_);
    return bodies_;
  }

 private:
  void serve() {
    for (;;) {
      const int one = ::accept(listening_, nullptr, nullptr);
      if (one < 0) return;
      std::string bytes;
      char buffer[4096];
      size_t head = std::string::npos;
      size_t length = 0;
      while (head == std::string::npos || bytes.size() < head + 4 + length) {
        const ssize_t count = ::recv(one, buffer, sizeof buffer, 0);
        if (count <= 0) break;
        bytes.append(buffer, static_cast<size_t>(count));
        head = bytes.find("\r\n\r\n");
        const size_t field = bytes.find("Content-Length: ");
        if (field != std::string::npos)
          length = std::strtoul(bytes.c_str() + field + 16, nullptr, 10);
      }
      int status = 200;
      std::string location = url();
      {
        const std::lock_guard lock(mutex_);
        if (head != std::string::npos) bodies_.push_back(bytes.substr(head + 4));
        if (!location_.empty()) location = location_;
        if (!statuses_.empty()) {
          status = statuses_.front();
          statuses_.erase(statuses_.begin());
        }
      }
      const std::string reply = "HTTP/1.1 " + std::to_string(status) +
                                " X\r\nContent-Length: 0\r\nConnection: close\r\n" +
                                (status / 100 == 3 ? "Location: " + location + "\r\n" : "") +
                                "\r\n";
      (void)::send(one, reply.data(), reply.size(), MSG_NOSIGNAL);
      ::close(one);
    }
  }

  int listening_ = -1;
  uint16_t port_ = 0;
  mutable std::mutex mutex_;
  std::vector<int> statuses_;
  std::string location_;
  std::vector<std::string> bodies_;
  std::thread thread_;
};

}  // namespace hyades::coordinator
