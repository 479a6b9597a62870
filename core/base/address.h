#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// Nothing where `text` is HOST:PORT: a name, an IPv4 address or an IPv6 address in brackets, and a
/// decimal port from 0 to 65535. Else an error that says what was expected.
Status check_address(const std::string& text);

/// The two parts of what check_address() lets pass, the host without brackets.
struct Address {
  std::string host;
  std::string port;
};
Address split_address(const std::string& text);

}  // namespace hyades::core
