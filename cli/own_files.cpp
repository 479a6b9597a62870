#include "cli/own_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;

/// Headers stand within the first and the last so many bytes.
constexpr std::streamoff kHeader = 1 << 18;
/// From what names the job to its name: a type, a length, a line of a film's header.
constexpr size_t kBefore = 600;

std::string part_of(std::ifstream& file, std::streamoff from, std::streamoff bytes) {
  std::string text(static_cast<size_t>(bytes), '\0');
  file.seekg(from);
  file.read(text.data(), bytes);
  return text;
}

bool names_job(std::string_view header, const std::string& job) {
  // Formats write other letters than these in ways of their own.
  const bool plain =
      std::all_of(job.begin(), job.end(), [](char c) { return c > ' ' && c <= '~' && c != '\\'; });
  for (const std::string_view mark : {"hyades.job", "hyades film "}) {
    const size_t at = header.find(mark);
    if (at == std::string_view::npos) continue;
    const std::string_view after = header.substr(at + mark.size(), kBefore + job.size());
    if (!plain || after.find(job) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

bool is_of_job(const std::string& path, const std::string& job) {
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  const auto size = static_cast<std::streamoff>(fs::file_size(path, none));
  if (!file || none) return false;
  const std::streamoff bytes = std::min(size, kHeader);
  return names_job(part_of(file, 0, bytes), job) ||
         names_job(part_of(file, size - bytes, bytes), job);
}

core::Status check_own_files(const std::vector<std::string>& paths, const std::string& job) {
  std::string first;
  size_t others = 0;
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_regular_file(path, none) || is_of_job(path, job)) continue;
    if (first.empty()) first = path;
    ++others;
  }
  if (first.empty()) return {};
  return core::Error{fmt::format(
      "{}{} there, and no file of the job '{}': --overwrite replaces it, --output DIR writes "
      "elsewhere",
      first, others > 1 ? fmt::format(" (and {} others) are", others - 1) : " is", job)};
}

}  // namespace hyades::cli
