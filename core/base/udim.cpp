#include "core/base/udim.h"

#include <cstddef>
#include <string_view>

namespace hyades::core {
namespace {

constexpr std::string_view kMark = "<UDIM>";

}  // namespace

bool is_udim(const std::string& file) { return file.find(kMark) != std::string::npos; }

std::string udim_file(const std::string& pattern, int number) {
  const size_t at = pattern.find(kMark);
  if (at == std::string::npos) return pattern;
  return pattern.substr(0, at) + std::to_string(number) + pattern.substr(at + kMark.size());
}

Result<std::vector<int>> udim_tiles(AssetResolver& assets, const std::string& pattern) {
  std::vector<int> tiles;
  for (int i = 0; i < kUdimColumns * kUdimRows; ++i) {
    if (assets.exists(udim_file(pattern, kFirstUdim + i))) tiles.push_back(kFirstUdim + i);
  }
  if (!tiles.empty()) return tiles;
  return Error{pattern + ": no tile exists, expected " + udim_file(pattern, kFirstUdim) + " to " +
               udim_file(pattern, kFirstUdim + kUdimColumns * kUdimRows - 1)};
}

}  // namespace hyades::core
