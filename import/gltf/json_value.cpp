#include "import/gltf/json_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace hyades::core {

namespace {

std::string found(const nlohmann::json& value) {
  if (value.is_structured()) return value.is_array() ? "a list" : "an object";
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  return text;
}

}  // namespace

void JsonValue::complain(const std::string& what) const {
  if (trouble_->none()) trouble_->message = place_ + " " + what;
}

JsonValue JsonValue::member(std::string_view key) const {
  const std::string place = place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key);
  if (value_ == nullptr) return {nullptr, place, *trouble_};
  if (!value_->is_object()) {
    complain(fmt::format("is {}, expected an object", found(*value_)));
    return {nullptr, place, *trouble_};
  }
  const auto at = value_->find(key);
  return {at == value_->end() ? nullptr : &*at, place, *trouble_};
}

std::vector<std::string> JsonValue::keys() const {
  std::vector<std::string> names;
  if (value_ == nullptr) return names;
  if (!value_->is_object()) {
    complain(fmt::format("is {}, expected an object", found(*value_)));
    return names;
  }
  for (auto at = value_->begin(); at != value_->end(); ++at) names.push_back(at.key());
  return names;
}

std::vector<JsonValue> JsonValue::list(std::string_view key) const {
  const JsonValue at = member(key);
  std::vector<JsonValue> items;
  if (!at.exists()) return items;
  if (!at.value_->is_array()) {
    at.complain(fmt::format("is {}, expected a list", found(*at.value_)));
    return items;
  }
  items.reserve(at.value_->size());
  for (const nlohmann::json& item : *at.value_) {
    items.emplace_back(&item, fmt::format("{}[{}]", at.place_, items.size()), *trouble_);
  }
  return items;
}

std::optional<int64_t> JsonValue::whole(int64_t low, int64_t high) const {
  std::optional<int64_t> number;
  if (value_->is_number_unsigned()) {
    const auto u = value_->get<uint64_t>();
    if (u <= static_cast<uint64_t>(INT64_MAX)) number = static_cast<int64_t>(u);
  } else if (value_->is_number_integer()) {
    number = value_->get<int64_t>();
  } else if (value_->is_number_float()) {
    // Some programs write 3.0 for 3.
    const auto d = value_->get<double>();
    if (std::fabs(d) < 9.0e15 && d == std::floor(d)) number = static_cast<int64_t>(d);
  }
  if (!number || *number < low || *number > high) {
    complain(
        fmt::format("is {}, expected a whole number from {} to {}", found(*value_), low, high));
    return std::nullopt;
  }
  return number;
}

std::optional<float> JsonValue::real() const {
  if (!value_->is_number()) {
    complain(fmt::format("is {}, expected a number", found(*value_)));
    return std::nullopt;
  }
  const auto number = static_cast<float>(value_->get<double>());
  if (!std::isfinite(number)) {
    complain(fmt::format("is {}, which is too large", found(*value_)));
    return std::nullopt;
  }
  return number;
}

int64_t JsonValue::integer(std::string_view key, int64_t low, int64_t high, int64_t absent) const {
  const JsonValue at = member(key);
  if (!at.exists()) return absent;
  return at.whole(low, high).value_or(absent);
}

int64_t JsonValue::required_integer(std::string_view key, int64_t low, int64_t high) const {
  const JsonValue at = member(key);
  if (!at.exists()) {
    at.complain("is missing");
    return low;
  }
  return at.whole(low, high).value_or(low);
}

int JsonValue::as_index(size_t count) const {
  if (count == 0) {
    complain(fmt::format("is {}, but there are none of these", found(*value_)));
    return -1;
  }
  return static_cast<int>(whole(0, static_cast<int64_t>(count) - 1).value_or(-1));
}

int JsonValue::index(std::string_view key, size_t count) const {
  const JsonValue at = member(key);
  return at.exists() ? at.as_index(count) : -1;
}

int JsonValue::required_index(std::string_view key, size_t count) const {
  const JsonValue at = member(key);
  if (!at.exists()) {
    at.complain("is missing");
    return -1;
  }
  return at.as_index(count);
}

float JsonValue::number(std::string_view key, float absent, float low, float high) const {
  const JsonValue at = member(key);
  if (!at.exists()) return absent;
  const auto number = at.real();
  if (!number) return absent;
  if (*number < low || *number > high) {
    at.complain(high < 3.0e38F ? fmt::format("is {}, expected {} to {}", *number, low, high)
                               : fmt::format("is {}, expected at least {}", *number, low));
    return absent;
  }
  return *number;
}

std::vector<float> JsonValue::numbers(std::string_view key) const {
  std::vector<float> out;
  for (const JsonValue& item : list(key)) out.push_back(item.real().value_or(0.0F));
  return out;
}

bool JsonValue::numbers(std::string_view key, std::span<float> out) const {
  const JsonValue at = member(key);
  if (!at.exists()) return false;
  const std::vector<float> read = numbers(key);
  if (read.size() != out.size()) {
    at.complain(fmt::format("has {} numbers, expected {}", read.size(), out.size()));
    return false;
  }
  std::copy(read.begin(), read.end(), out.begin());
  return true;
}

std::string JsonValue::as_text() const {
  if (!value_->is_string()) {
    complain(fmt::format("is {}, expected a text", found(*value_)));
    return {};
  }
  return value_->get<std::string>();
}

std::string JsonValue::text(std::string_view key) const {
  const JsonValue at = member(key);
  return at.exists() ? at.as_text() : std::string();
}

bool JsonValue::flag(std::string_view key, bool absent) const {
  const JsonValue at = member(key);
  if (!at.exists()) return absent;
  if (!at.value_->is_boolean()) {
    at.complain(fmt::format("is {}, expected true or false", found(*at.value_)));
    return absent;
  }
  return at.value_->get<bool>();
}

}  // namespace hyades::core
