#pragma once

#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace hyades::cli {

/// A check for options of CLI11: a number from `low` to `high`, both included. Like CLI::Range,
/// whose words differ from version to version.
template <typename Number>
CLI::Validator in_range(Number low, Number high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    Number number{};
    if (CLI::detail::lexical_cast(text, number) && number >= low && number <= high) return {};
    return fmt::format("{}: expected {} to {}", text, low, high);
  };
  return {check, fmt::format("{} in [{} - {}]", CLI::detail::type_name<Number>(), low, high)};
}

}  // namespace hyades::cli
