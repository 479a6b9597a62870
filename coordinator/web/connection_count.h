#pragma once

#include <cstddef>
#include <map>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace hyades::coordinator {

/// How many connections are open, and of whom, so that nobody takes all of them. Not thread-safe.
class ConnectionCount {
 public:
  /// At most `most` are open at once, and of one owner (owner_of) at most `most_of_one` and a
  /// quarter of what is left, but `sure` in any case. So a few owners cannot take all: of four that
  /// try each gets an eighth, and one who comes later as much as they have.
  ConnectionCount(size_t most, size_t most_of_one, size_t sure)
      : most_(most), most_of_one_(most_of_one), sure_(sure) {}

  /// Whether one more may come from there. This machine, where a proxy may be, may have all.
  bool may_come(const boost::asio::ip::address& from) const;
  /// Counts one that has come.
  void enter(const boost::asio::ip::address& from);
  /// Counts one that has gone; once for each that has entered.
  void leave(const boost::asio::ip::address& from);

  /// Whom an address belongs to (neighbourhood_of()): an IPv4 address itself, or the /64 network of
  /// an IPv6 one.
  static std::string owner_of(const boost::asio::ip::address& address);

 private:
  size_t most_;
  size_t most_of_one_;
  size_t sure_;
  size_t open_ = 0;
  std::map<std::string, size_t> open_of_;
};

}  // namespace hyades::coordinator
