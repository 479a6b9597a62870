#include "core/base/leftovers.h"

#include <string_view>
#include <system_error>

namespace hyades::core {
namespace {

/// NAME of ".NAME.16 hex digits.tmp"; empty for all other names.
std::string_view target_of(std::string_view name) {
  constexpr std::string_view kEnd = ".tmp";
  constexpr size_t kUnique = 16;
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return {};
  name = name.substr(1, name.size() - 1 - kEnd.size());
  if (name.size() < kUnique + 2) return {};
  const std::string_view unique = name.substr(name.size() - kUnique);
  if (unique.find_first_not_of("0123456789abcdef") != std::string_view::npos) return {};
  name.remove_suffix(kUnique);
  if (!name.ends_with('.')) return {};
  name.remove_suffix(1);
  return name;
}

}  // namespace

std::vector<Leftover> find_leftovers(const std::string& folder,
                                     std::filesystem::file_time_type before) {
  std::vector<Leftover> found;
  std::error_code failed;
  std::filesystem::directory_iterator entry(folder, failed);
  for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    const std::string_view target = target_of(name);
    if (target.empty()) continue;
    std::error_code gone;
    if (!entry->is_regular_file(gone) || gone) continue;
    const auto written = entry->last_write_time(gone);
    if (!gone && written < before) found.push_back({entry->path().string(), std::string(target)});
  }
  return found;
}

}  // namespace hyades::core
