#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/text.h"

namespace hyades::core {

/// One row of a table "name in a job -> what it stands for".
template <class Value>
struct NameRow {
  std::string_view name;
  Value value;
};

template <class Value, size_t N>
std::vector<std::string> names_of(const std::array<NameRow<Value>, N>& table) {
  std::vector<std::string> names;
  for (const auto& row : table) names.emplace_back(row.name);
  return names;
}

/// The row of `name`, in a table that stays. `what` says of what the names are ("type of texture")
/// for the error, which lists those that there are.
template <class Value, size_t N>
Result<const NameRow<Value>*> look_up(const std::array<NameRow<Value>, N>& table,
                                      std::string_view name, std::string_view what) {
  for (const auto& row : table) {
    if (row.name == name) return &row;
  }
  return Error{"there is no " + std::string(what) + " '" + std::string(name) +
               "', expected one of " + join_names(names_of(table))};
}

}  // namespace hyades::core
