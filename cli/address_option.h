#pragma once

#include <string>

#include "core/base/address.h"

namespace hyades::cli {

/// What is wrong with HOST:PORT, or nothing: a check for options of CLI11.
inline std::string address_error(const std::string& text) {
  const core::Status checked = core::check_address(text);
  return checked ? "" : checked.error().message;
}

}  // namespace hyades::cli
