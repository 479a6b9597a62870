#include "coordinator/web/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

namespace hyades::coordinator {
namespace {

std::string_view trim(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

/// "0", "0.0", "0.000": what nobody wants.
bool is_zero(std::string_view quality) {
  return !quality.empty() &&
         std::all_of(quality.begin(), quality.end(), [](char c) { return c == '0' || c == '.'; });
}

}  // namespace

std::string gzip(std::string_view bytes) {
  constexpr int kLargestWindow = 15;
  constexpr int kWithHeader = 16;  // of gzip instead of zlib's own
  constexpr int kMostMemory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kLargestWindow + kWithHeader,
                   kMostMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    return {};
  }
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  packed.resize(done ? stream.total_out : 0);
  deflateEnd(&stream);
  return packed;
}

bool takes_gzip(std::string_view header) {
  bool any = false;
  while (!header.empty()) {
    const std::string_view one = header.substr(0, header.find(','));
    header.remove_prefix(std::min(header.size(), one.size() + 1));
    const std::string_view name = trim(one.substr(0, one.find(';')));
    const size_t quality = one.find("q=");
    const bool wanted =
        quality == std::string_view::npos || !is_zero(trim(one.substr(quality + 2)));
    if (name == "gzip" || name == "x-gzip") return wanted;
    if (name == "*") any = wanted;
  }
  return any;
}

}  // namespace hyades::coordinator
