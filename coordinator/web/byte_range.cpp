#include "coordinator/web/byte_range.h"

#include <algorithm>
#include <cstddef>

#include "coordinator/web/number.h"

namespace hyades::coordinator {
RangeAsked read_range(std::string_view header, uint64_t size, ByteRange& range) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit)) return RangeAsked::whole;
  header.remove_prefix(kUnit.size());
  const size_t dash = header.find('-');
  if (dash == std::string_view::npos || header.find(',') != std::string_view::npos) {
    return RangeAsked::whole;
  }
  const std::string_view from = header.substr(0, dash);
  const std::string_view to = header.substr(dash + 1);
  if (from.empty()) {  // the last so many
    const auto count = number_of<uint64_t>(to);
    if (!count) return RangeAsked::whole;
    if (*count == 0 || size == 0) return RangeAsked::impossible;
    range = {size - std::min(*count, size), size - 1};
    return RangeAsked::part;
  }
  const auto first = number_of<uint64_t>(from);
  const auto last = to.empty() ? std::optional(UINT64_MAX) : number_of<uint64_t>(to);
  if (!first || !last || *last < *first) return RangeAsked::whole;
  if (*first >= size) return RangeAsked::impossible;
  range = {*first, std::min(*last, size - 1)};
  return RangeAsked::part;
}

}  // namespace hyades::coordinator
