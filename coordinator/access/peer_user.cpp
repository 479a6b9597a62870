#include "coordinator/access/peer_user.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "coordinator/access/address.h"

namespace hyades::coordinator {
namespace {

struct Place {
  std::string host;
  uint16_t port = 0;
};

/// Of "0100007F:1F90": words of 32 bits in the processor's order, and the port as a number.
std::optional<Place> read_place(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon != 8 && colon != 32) return std::nullopt;
  std::array<uint32_t, 4> words{};
  for (size_t i = 0; i * 8 < colon; ++i) {
    const char* from = text.data() + i * 8;
    if (std::from_chars(from, from + 8, words[i], 16).ptr != from + 8) return std::nullopt;
  }
  Place place;
  const char* end = text.data() + text.size();
  if (std::from_chars(text.data() + colon + 1, end, place.port, 16).ptr != end) return std::nullopt;
  std::array<char, INET6_ADDRSTRLEN> host{};
  if (::inet_ntop(colon == 8 ? AF_INET : AF_INET6, words.data(), host.data(), host.size()) ==
      nullptr) {
    return std::nullopt;
  }
  place.host = host.data();
  return place;
}

}  // namespace

std::optional<uid_t> user_of_peer(const std::string& peer, const std::set<uint16_t>& ports) {
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream lines(path);
    std::string line;
    std::getline(lines, line);  // what the columns are
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string number, local, remote, state, queues, timer, retransmits;
      uid_t user = 0;
      if (!(words >> number >> local >> remote >> state >> queues >> timer >> retransmits >>
            user)) {
        continue;
      }
      if (state != "01") continue;  // established
      const auto to = read_place(remote);
      const auto from = read_place(local);
      if (!from || !to || !ports.contains(to->port)) continue;
      if (address_text(from->host, std::to_string(from->port)) == peer) return user;
    }
  }
  return std::nullopt;
}

}  // namespace hyades::coordinator
