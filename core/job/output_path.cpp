#include "core/job/output_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace hyades::core {

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

std::string file_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

bool same_output_path(const std::string& a, const std::string& b) {
  // Runs of different length may still meet at long frame numbers.
  return std::filesystem::path(output_path(a, 1'000'000'000)).lexically_normal() ==
         std::filesystem::path(output_path(b, 1'000'000'000)).lexically_normal();
}

}  // namespace hyades::core
