#include "core/job/output_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "core/base/text.h"

namespace hyades::core {

namespace {

std::filesystem::path comparable(const std::string& file) {
  // Runs of # of different length may still meet at long frame numbers.
  return std::filesystem::path(output_path(file, 1'000'000'000)).lexically_normal();
}

}  // namespace

std::string output_path(const std::string& file, int32_t frame) {
  std::string path;
  for (size_t i = 0; i < file.size();) {
    const size_t end = std::min(file.find_first_not_of('#', i), file.size());
    if (end > i) path += fmt::format("{:0{}}", frame, end - i);
    const size_t next = std::min(file.find('#', end), file.size());
    path += file.substr(end, next - end);
    i = next;
  }
  return path;
}

OutputName output_name(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.is_absolute()) return OutputName::outside;
  bool special = false;
  bool reserved = false;
  for (const std::filesystem::path& each : path) {
    const std::string part = each.string();
    if (part == "..") return OutputName::outside;
    reserved = reserved || part == ".hyades";
    special = special || part.starts_with('-') || (part.starts_with('.') && part != ".");
  }
  // At any depth: a folder among one run's outputs may be the output folder of another.
  if (reserved) return OutputName::reserved;
  return special ? OutputName::special : OutputName::plain;
}

std::string file_extension(const std::string& file) {
  return lower_case(std::filesystem::path(file).extension().string());
}

std::string place_of_output(const std::string& file) {
  std::string place = comparable(file).generic_string();
  std::replace(place.begin(), place.end(), '/', '\0');
  return place;
}

bool same_output_path(const std::string& a, const std::string& b) {
  return comparable(a) == comparable(b);
}

bool nested_output_paths(const std::string& a, const std::string& b) {
  const std::filesystem::path one = comparable(a);
  const std::filesystem::path two = comparable(b);
  const auto [at_one, at_two] = std::mismatch(one.begin(), one.end(), two.begin(), two.end());
  return one != two && (at_one == one.end() || at_two == two.end());
}

}  // namespace hyades::core
