#include "coordinator/film_store/log_names.h"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

namespace hyades::coordinator {
namespace {

constexpr std::string_view kAppended = ".films";
constexpr std::string_view kSnapshot = ".snapshot";

}  // namespace

std::string segment_name(const SegmentName& name) {
  return fmt::format("{:08}{}", name.index, name.snapshot ? kSnapshot : kAppended);
}

std::optional<SegmentName> parse_segment_name(const std::string& name) {
  SegmentName parsed;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, parsed.index);
  const std::string_view rest(stop, static_cast<size_t>(end - stop));
  parsed.snapshot = rest == kSnapshot;
  // Only names as segment_name makes them: "7.films" is somebody else's file.
  if (error != std::errc() || (!parsed.snapshot && rest != kAppended) ||
      segment_name(parsed) != name) {
    return std::nullopt;
  }
  return parsed;
}

bool is_log_file(const std::string& name) {
  std::string finished = name;
  if (finished.ends_with(kUnfinishedSuffix)) {
    finished.resize(finished.size() - std::string_view(kUnfinishedSuffix).size());
  }
  return finished == kGuardName || finished == kLockName || parse_segment_name(finished);
}

}  // namespace hyades::coordinator
