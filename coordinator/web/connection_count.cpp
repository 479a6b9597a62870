#include "coordinator/web/connection_count.h"

#include <algorithm>
#include <cstdint>

namespace hyades::coordinator {
namespace asio = boost::asio;

bool ConnectionCount::may_come(const asio::ip::address& from) const {
  if (open_ >= most_) return false;
  if (from.is_loopback()) return true;
  const auto known = open_of_.find(owner_of(from));
  return known == open_of_.end() || known->second < most_of_one_;
}

void ConnectionCount::enter(const asio::ip::address& from) {
  ++open_;
  ++open_of_[owner_of(from)];
}

void ConnectionCount::leave(const asio::ip::address& from) {
  const auto known = open_of_.find(owner_of(from));
  if (known == open_of_.end()) return;
  --open_;
  if (--known->second == 0) open_of_.erase(known);
}

std::string ConnectionCount::owner_of(const asio::ip::address& address) {
  if (!address.is_v6()) return address.to_string();
  const auto six = address.to_v6();
  if (six.is_v4_mapped()) return asio::ip::make_address_v4(asio::ip::v4_mapped, six).to_string();
  auto bytes = six.to_bytes();
  std::fill(bytes.begin() + 8, bytes.end(), uint8_t{0});
  return asio::ip::address_v6(bytes).to_string();
}

}  // namespace hyades::coordinator
