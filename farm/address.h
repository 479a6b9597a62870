#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::farm {

/// Nothing where `text` is HOST:PORT: a name, an IPv4 address or an IPv6 address in brackets, and a
/// decimal port from 0 to 65535. Else an error that says what was expected.
core::Status check_address(const std::string& text);

}  // namespace hyades::farm
