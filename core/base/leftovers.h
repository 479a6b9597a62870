#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hyades::core {

/// So many bytes of a target's name at most are part of the name of its temporary
/// (".NAME.16 hex digits.tmp", see replace_file).
inline constexpr size_t kNameInTemporary = 200;

/// A file that replace_file was writing when its process was killed.
struct Leftover {
  std::string path;
  std::string target;  ///< name of what it was to replace, its first kNameInTemporary bytes
};

/// The leftovers in `folder` (not below) that were last written before `before`. None where it
/// cannot be listed.
std::vector<Leftover> find_leftovers(const std::string& folder,
                                     std::filesystem::file_time_type before);

}  // namespace hyades::core
