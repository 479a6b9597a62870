// What gRPC says of a connection that does not come about, in words for people.
#include <cstddef>
#include <optional>
#include <string>

#include "farm/channel.h"

namespace hyades::farm {
namespace {

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

/// `text` from behind the last `mark` on; all of it where there is none.
std::string behind(const std::string& text, const std::string& mark) {
  const size_t at = text.rfind(mark);
  return at == std::string::npos ? text : text.substr(at + mark.size());
}

}  // namespace

std::optional<std::string> tls_trouble(const std::string& message, const Peer& peer) {
  if (peer.ca_file.empty()) {
    // A coordinator with TLS does not understand us, and hangs up before anything was said.
    const bool hung_up = has(message, "Socket closed") || has(message, "Connection reset by peer");
    if (!has(message, "failed to connect") || !hung_up) return std::nullopt;
    return "it hangs up at once: it may want TLS (--tls-ca FILE)";
  }
  if (has(message, "wrong version number")) {
    return "it does not speak TLS, which --tls-ca " + peer.ca_file + " asks for";
  }
  if (has(message, "certificate verify failed")) {
    return "its certificate is not signed by one in " + peer.ca_file +
           " (--tls-ca), or not valid today";
  }
  if (has(message, "Hostname Verification Check failed") ||
      has(message, "not in peer certificate")) {
    return "its certificate is for another name";
  }
  return std::nullopt;
}

std::string connection_trouble(const std::string& message, const Peer& peer) {
  if (const auto tls = tls_trouble(message, peer)) return *tls;
  const std::string line = message.substr(0, message.find('\n'));
  return behind(behind(line, "last error: "), "Failed to connect to remote host: ");
}

}  // namespace hyades::farm
