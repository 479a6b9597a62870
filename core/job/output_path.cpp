#include "core/job/output_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace hyades::core {

std::string output_path(const std::string& file, int32_t frame) {
  const size_t begin = file.find('#');
  if (begin == std::string::npos) return file;
  const size_t end = std::min(file.find_first_not_of('#', begin), file.size());
  return file.substr(0, begin) + fmt::format("{:0{}}", frame, end - begin) + file.substr(end);
}

int count_frame_marks(const std::string& file) {
  int runs = 0;
  for (size_t i = 0; i < file.size(); ++i) {
    if (file[i] == '#' && (i == 0 || file[i - 1] != '#')) ++runs;
  }
  return runs;
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
