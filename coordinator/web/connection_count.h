#pragma once

#include <cstddef>
#include <map>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace hyades::coordinator {

/// How many connections are open, and of whom: nobody takes all of them. Of one thread.
class ConnectionCount {
 public:
  /// `most` of all, `most_of_one` of one address (owner_of).
  ConnectionCount(size_t most, size_t most_of_one) : most_(most), most_of_one_(most_of_one) {}

  /// Whether one more may come from there. This machine, where a proxy may be, has as many as there
  /// are.
  bool may_come(const boost::asio::ip::address& from) const;
  void enter(const boost::asio::ip::address& from);
  /// Once for each that has entered.
  void leave(const boost::asio::ip::address& from);

  /// Whom an address belongs to: an IPv4 address, or the /64 of an IPv6 one, of which everybody has
  /// as many as he likes.
  static std::string owner_of(const boost::asio::ip::address& address);

 private:
  size_t most_;
  size_t most_of_one_;
  size_t open_ = 0;
  std::map<std::string, size_t> open_of_;
};

}  // namespace hyades::coordinator
