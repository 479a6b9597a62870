#include "coordinator/backup/manifest.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kTitle = "hyades backup 1";
constexpr std::string_view kEnd = "end ";
constexpr size_t kDigest = 64;

bool is_digest(std::string_view text) {
  return text.size() == kDigest && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace

std::string write_manifest(const Manifest& manifest) {
  std::string text = std::string(kTitle) + "\n";
  for (const auto& [path, file] : manifest.files) {
    text += fmt::format("{} {} {}\n", file.sha256, file.size, path);
  }
  return text + std::string(kEnd) + core::to_hex(core::sha256(text)) + "\n";
}

core::Result<Manifest> parse_manifest(const std::string& text) {
  const core::Error damaged{"the backup's list of files is damaged"};
  const size_t last = text.size() < 2 ? std::string::npos : text.rfind('\n', text.size() - 2);
  if (last == std::string::npos || text.back() != '\n') return damaged;
  const std::string before = text.substr(0, last + 1);
  if (text.substr(last + 1) != std::string(kEnd) + core::to_hex(core::sha256(before)) + "\n") {
    return damaged;
  }
  std::istringstream lines(before);
  std::string line;
  if (!std::getline(lines, line) || line != kTitle) {
    return core::Error{"the backup is of another version of Hyades: it says '" +
                       line.substr(0, 40) + "'"};
  }
  Manifest manifest;
  while (std::getline(lines, line)) {
    const size_t space = line.find(' ', kDigest + 1);
    if (line.size() < kDigest + 4 || line[kDigest] != ' ' || space == std::string::npos) {
      return damaged;
    }
    Manifest::File file;
    file.sha256 = line.substr(0, kDigest);
    const auto [end, failed] =
        std::from_chars(line.data() + kDigest + 1, line.data() + space, file.size);
    const std::string path = line.substr(space + 1);
    if (!is_digest(file.sha256) || failed != std::errc() || end != line.data() + space ||
        !is_backup_path(path) || !manifest.files.emplace(path, file).second) {
      return damaged;
    }
  }
  return manifest;
}

bool is_audit_file(const std::string& name) {
  constexpr std::string_view kEnd = "jsonl";
  for (const std::string_view begin : {"audit.", "refusals.", "uploads."}) {
    if (!name.starts_with(begin) || !name.ends_with(kEnd)) continue;
    const std::string number = name.substr(begin.size(), name.size() - begin.size() - kEnd.size());
    return number.empty() ||
           (number.size() == 2 && number[0] >= '1' && number[0] <= '9' && number[1] == '.');
  }
  return false;
}

bool is_backup_path(const std::string& path) {
  if (path == "state.db" || path == "state.db.starts" || is_audit_file(path)) return true;
  const bool below =
      path.starts_with("films/") || path.starts_with("outputs/") || path.starts_with("assets/");
  if (!below || path.back() == '/' || path.find('\0') != std::string::npos ||
      path.find('\n') != std::string::npos) {
    return false;
  }
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty() || part == "." || part == "..") return false;
  }
  return true;
}

}  // namespace hyades::coordinator
