#include "tests/coordinator/web/http_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>

namespace hyades::coordinator {
namespace {

void send_all(int socket, const std::string& bytes) {
  size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;
    sent += static_cast<size_t>(count);
  }
}

/// False at the end, or after 20 s of silence.
bool receive(int socket, std::string& bytes) {
  char buffer[65536];
  const ssize_t count = ::recv(socket, buffer, sizeof buffer, 0);
  if (count <= 0) return false;
  bytes.append(buffer, static_cast<size_t>(count));
  return true;
}

std::string take_line(std::string& bytes) {
  const size_t end = bytes.find("\r\n");
  std::string line = bytes.substr(0, end);
  bytes.erase(0, end == std::string::npos ? bytes.size() : end + 2);
  return line;
}

std::string small_letters(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// A chunked body as one; whether it is whole.
bool join_chunks(std::string& body) {
  std::string joined;
  for (;;) {
    const std::string line = take_line(body);
    if (line.empty()) return false;
    const size_t count = std::strtoul(line.c_str(), nullptr, 16);
    if (body.size() < count + 2) return false;
    joined += body.substr(0, count);
    body.erase(0, count + 2);
    if (count == 0) break;
  }
  body = joined;
  return true;
}

HttpClient::Response read_response(std::string bytes) {
  HttpClient::Response response;
  if (bytes.find("\r\n\r\n") == std::string::npos) return response;
  const std::string first = take_line(bytes);
  if (first.size() > 9) response.status = std::atoi(first.c_str() + 9);
  for (std::string line = take_line(bytes); !line.empty(); line = take_line(bytes)) {
    const size_t colon = line.find(':');
    response.headers[small_letters(line.substr(0, colon))] =
        line.substr(std::min(line.size(), colon + 2));
  }
  response.body = std::move(bytes);
  const auto length = response.headers.find("content-length");
  if (response.headers.contains("transfer-encoding")) {
    response.whole = join_chunks(response.body);
  } else {
    response.whole = length == response.headers.end() ||
                     response.body.size() == std::strtoull(length->second.c_str(), nullptr, 10);
  }
  return response;
}

}  // namespace

HttpClient::HttpClient(const std::string& url)
    : port_(std::atoi(url.substr(url.rfind(':') + 1).c_str())) {}

int HttpClient::connect() const {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{20, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<uint16_t>(port_));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  (void)::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  return socket;
}

std::string HttpClient::exchange(const std::string& bytes) const {
  const int socket = connect();
  send_all(socket, bytes);
  std::string received;
  while (receive(socket, received)) {
  }
  ::close(socket);
  return received;
}

HttpClient::Response HttpClient::send(const std::string& method, const std::string& target,
                                      const std::string& body, const Headers& headers) const {
  std::string request = method + " " + target + " HTTP/1.1\r\nConnection: close\r\n";
  bool has_host = false;
  for (const auto& [name, value] : headers) {
    request += name + ": " + value + "\r\n";
    has_host = has_host || name == "Host";
  }
  if (!has_host) request += "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n";
  if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return read_response(exchange(request + "\r\n" + body));
}

HttpClient::Events::Events(const HttpClient& client, const std::string& target,
                           const Headers& headers)
    : socket_(client.connect()) {
  std::string request = "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n";
  for (const auto& [name, value] : headers) request += name + ": " + value + "\r\n";
  send_all(socket_, request + "\r\n");
  size_t end = std::string::npos;
  while ((end = waiting_.find("\r\n\r\n")) == std::string::npos && more()) {
  }
  if (end == std::string::npos) return;
  status_ = std::atoi(waiting_.c_str() + 9);
  waiting_.erase(0, end + 4);
}

HttpClient::Events::~Events() { ::close(socket_); }

bool HttpClient::Events::more() { return receive(socket_, waiting_); }

HttpClient::Events::Event HttpClient::Events::next() {
  for (;;) {
    const size_t end = waiting_.find("\n\n");
    if (end == std::string::npos) {
      if (!more()) return {};
      continue;
    }
    const std::string text = waiting_.substr(0, end);
    waiting_.erase(0, end + 2);
    if (text.starts_with(':')) continue;
    const size_t line = text.find('\n');
    return {text.substr(7, line - 7), text.substr(line + 7)};
  }
}

}  // namespace hyades::coordinator
