#pragma once

#include <cstdint>
#include <optional>
#include <string>

/// How the files in a film log's folder are called.
namespace hyades::coordinator {

inline constexpr const char* kGuardName = "log.key";
inline constexpr const char* kLockName = "log.lock";
inline constexpr const char* kUnfinishedSuffix = ".tmp";
/// The ending of files of films that are not in memory (films_aside.h). They are not the log's.
inline constexpr const char* kAsideSuffix = ".aside";

/// What the name of a segment file says.
struct SegmentName {
  uint64_t index = 0;
  bool snapshot = false;
};

/// "00000007.films", "00000008.snapshot".
std::string segment_name(const SegmentName& name);
/// What segment_name() made this name of; nothing where it did not.
std::optional<SegmentName> parse_segment_name(const std::string& name);

/// Whether a file of that name in the log's folder is the log's (also one left unfinished).
bool is_log_file(const std::string& name);

}  // namespace hyades::coordinator
