#include "coordinator/web/connection_count.h"

#include <algorithm>

#include "coordinator/access/address.h"

namespace hyades::coordinator {
namespace asio = boost::asio;

bool ConnectionCount::may_come(const asio::ip::address& from) const {
  if (open_ >= most_) return false;
  if (from.is_loopback()) return true;
  const auto known = open_of_.find(owner_of(from));
  if (known == open_of_.end()) return true;
  return known->second < std::max(sure_, std::min(most_of_one_, (most_ - open_) / 4));
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
  return neighbourhood_of(address_text(address.to_string(), "0"));
}

}  // namespace hyades::coordinator
