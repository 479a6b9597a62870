#pragma once

#include <string>

#include "farm/address.h"

namespace hyades::cli {

/// What is wrong with HOST:PORT, or nothing: a check for options of CLI11.
inline std::string address_error(const std::string& text) {
  const core::Status checked = farm::check_address(text);
  return checked ? "" : checked.error().message;
}

}  // namespace hyades::cli
