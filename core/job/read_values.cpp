#include "core/job/read_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <system_error>

#include "core/job/read_color.h"
#include "core/job/read_components.h"

namespace hyades::core {

namespace {

/// Each takes some 7 kB of memory, and more where it is long.
constexpr size_t kMostExpressions = 20'000;

bool is_expression(const YamlNode& node) {
  return node.kind == YamlNode::Kind::scalar && node.scalar.starts_with('=');
}

std::string expected_list(const ValueSite& site, const char* shape) {
  return std::string(shape) + " (each " + site.range.describe() + " or an expression)";
}

/// Reads a list of all components, or of as many as it has when that is allowed.
template <class T>
bool read_list(const ValueSite& site, const YamlNode& node, size_t least, Animated<T>& target) {
  constexpr size_t kMost = Animated<T>::kComponents;
  Animated<T> result = target;
  result.keys.clear();
  if (!site.context.spend(node.list.size(), node.where)) return false;
  if (node.list.size() < least || node.list.size() > kMost) {
    const char* const all = kMost == 2 ? "[x, y]" : "[x, y, z]";
    complain_mismatch(site, node, expected_list(site, least < kMost ? "[x, y] or [x, y, z]" : all));
    return false;
  }
  bool good = true;
  for (size_t i = 0; i < node.list.size(); ++i) {
    const ValueSite item{site.context, fmt::format("{}[{}]", site.label, i), site.range};
    good &= read_component(item, *node.list[i], result.constant[static_cast<int>(i)],
                           result.expressions[i]);
  }
  if (good) target = result;
  return good;
}

bool read_vector(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target) {
  if (node.kind == YamlNode::Kind::list) return read_list(site, node, 3, target);
  complain_mismatch(site, node, expected_list(site, "[x, y, z]"));
  return false;
}

bool read_number_pair(const ValueSite& site, const YamlNode& node, Animated<Vec2>& target) {
  if (node.kind == YamlNode::Kind::list) return read_list(site, node, 2, target);
  complain_mismatch(site, node, expected_list(site, "[x, y]"));
  return false;
}

bool read_scale(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target) {
  if (node.kind == YamlNode::Kind::list) return read_list(site, node, 2, target);
  Animated<float> all;
  if (node.kind != YamlNode::Kind::scalar) {
    complain_mismatch(site, node, site.range.describe() + ", or a list of them");
    return false;
  }
  if (!read_component(site, node, all.constant, all.expressions[0])) return false;
  target = Animated<Vec3>(Vec3(all.constant));
  target.expressions.fill(all.expressions[0]);
  return true;
}

bool read_single(const ValueSite& site, const YamlNode& node, Animated<float>& target) {
  Animated<float> result;
  if (!read_component(site, node, result.constant, result.expressions[0])) return false;
  target = result;
  return true;
}

/// [x, y, z, w], not all 0.
bool read_quaternion(const ValueSite& site, const YamlNode& node, Animated<Vec4>& target) {
  Vec4 value(0.0F);
  bool good = node.kind == YamlNode::Kind::list && node.list.size() == 4;
  for (int i = 0; good && i < 4; ++i) {
    double number = 0.0;
    const YamlNode& item = *node.list[static_cast<size_t>(i)];
    good = item.kind == YamlNode::Kind::scalar && !item.quoted &&
           parse_number(item.scalar, number) && site.range.contains(number);
    value[i] = static_cast<float>(number);
  }
  const float size2 = glm::dot(value, value);
  if (!good || !(size2 > 1e-20F) || !std::isfinite(size2)) {
    complain_mismatch(site, node, "a quaternion [x, y, z, w], not all 0, or keys of them");
    return false;
  }
  target = Animated<Vec4>(value);
  return true;
}

/// What helps where a number was written as others have it: as a text, or with its unit.
std::string hint_for_number(const YamlNode& found, const std::string& expected) {
  double number = 0.0;
  const bool computes = found.scalar.find_first_of("*+/()") != std::string::npos &&
                        std::any_of(found.scalar.begin(), found.scalar.end(), [](char c) {
                          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
                        });
  if (computes && expected.starts_with("a number")) return " (an expression begins with '=')";
  if (found.quoted) return parse_number(found.scalar, number) ? " (without quotes)" : "";
  const std::string_view text = found.scalar;
  const size_t end = text.find_last_of("0123456789.") + 1;
  const size_t unit = std::min(text.find_first_not_of(' ', end), text.size());
  if (!parse_number(text.substr(0, end), number)) return "";
  for (const char* length : {"mm", "cm", "m", "km", "in", "ft"}) {
    if (text.substr(unit) == length)
      return " (without a unit: 'units' of the job is that of lengths)";
  }
  if (text.substr(unit) == "W") return " (without a unit: powers are in watts)";
  for (const char* angle : {"deg", "°"}) {
    if (text.substr(unit) == angle) return " (without a unit: angles are in degrees)";
  }
  return "";
}

}  // namespace

void complain_mismatch(const ValueSite& site, const YamlNode& found, const std::string& expected) {
  const std::string hint = hint_for_number(found, expected);
  site.context.complain(found.where,
                        site.label + " is " + describe(found) + ", expected " + expected + hint);
}

bool parse_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('+')) return false;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size() &&
         std::isfinite(value);
}

namespace {

constexpr size_t kMostLettersOfName = 100;

/// What a name may begin with.
bool begins_name(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool is_of_name(char c) { return begins_name(c) || c == '-' || c == '.' || c == ' '; }

}  // namespace

bool is_valid_name(std::string_view name) {
  return !name.empty() && name.size() <= kMostLettersOfName && name.back() != ' ' &&
         begins_name(name.front()) && std::all_of(name.begin(), name.end(), is_of_name);
}

std::string valid_name(std::string_view text) {
  std::string name(text.substr(0, kMostLettersOfName));
  // Not in the middle of a letter of several bytes.
  for (size_t i = name.size(); text.size() > name.size() && i > 0; --i) {
    const bool continues = (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
    if (!continues) {
      name.resize(i);
      break;
    }
  }
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_of_name(c); }, '_');
  while (!name.empty() && name.back() == ' ') name.pop_back();
  if (name.empty()) return "job";
  if (!begins_name(name.front())) name.front() = '_';
  return name;
}

bool read_component(const ValueSite& site, const YamlNode& node, float& constant,
                    std::shared_ptr<const Expression>& expression) {
  if (is_expression(node)) {
    // Each is among the checks.
    if (site.context.job.checks.numbers.size() >= kMostExpressions) {
      site.context.complain(node.where,
                            fmt::format("{}: the job has more than {} expressions; expected keys, "
                                        "or fewer that move",
                                        site.label, kMostExpressions));
      return false;
    }
    auto compiled = compile_expression(node.scalar.substr(1));
    if (!compiled) {
      site.context.complain(node.where, site.label + ": " + compiled.error().message);
      return false;
    }
    expression = *compiled;
    site.context.job.checks.numbers.push_back(
        {expression, site.range, node.where, site.label, site.context.in_shutter});
    return true;
  }
  if (!read_number(site, node, constant)) return false;
  expression = nullptr;
  return true;
}

bool read_number(const ValueSite& site, const YamlNode& node, float& target) {
  double value = 0.0;
  const bool number =
      node.kind == YamlNode::Kind::scalar && !node.quoted && parse_number(node.scalar, value);
  if (!number || !site.range.contains(value)) {
    const char* const size = number && std::abs(value) > 1e18 ? ", no larger than 1e18" : "";
    complain_mismatch(site, node, site.range.describe() + size);
    return false;
  }
  target = static_cast<float>(value);
  return true;
}

bool read_integer(const ValueSite& site, const YamlNode& node, int64_t low, int64_t high,
                  int64_t& target) {
  int64_t value = 0;
  const std::string& text = node.scalar;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = node.kind == YamlNode::Kind::scalar && !node.quoted &&
                      result.ec == std::errc{} && result.ptr == text.data() + text.size();
  if (!number || value < low || value > high) {
    complain_mismatch(site, node, fmt::format("a whole number from {} to {}", low, high));
    return false;
  }
  target = value;
  return true;
}

bool read_animated_number(const ValueSite& site, const YamlNode& node, Animated<float>& target) {
  return read_animated<float>(site, node, target, read_single);
}

bool read_animated_vector(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target) {
  return read_animated<Vec3>(site, node, target, read_vector);
}

bool read_animated_pair(const ValueSite& site, const YamlNode& node, Animated<Vec2>& target) {
  return read_animated<Vec2>(site, node, target, read_number_pair);
}

bool read_animated_scale(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target) {
  return read_animated<Vec3>(site, node, target, read_scale);
}

bool read_animated_rotation(const ValueSite& site, const YamlNode& node, Animated<Vec4>& target) {
  return read_animated<Vec4>(site, node, target, read_quaternion);
}

bool read_animated_color(const ValueSite& site, const YamlNode& node, Animated<Rgb>& target) {
  if (refuse_texture(site, node)) return false;
  return read_animated<Rgb>(site, node, target, read_color);
}

}  // namespace hyades::core
