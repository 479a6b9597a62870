#include "core/base/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

constexpr int kGzipWindow = 15 + 16;  ///< zlib's largest window, and gzip's header
constexpr size_t kFirstRoom = size_t{1} << 16;

/// A stream of zlib that ends with its scope.
class Inflater {
 public:
  Inflater() { ready_ = inflateInit2(&stream_, kGzipWindow) == Z_OK; }
  ~Inflater() {
    if (ready_) inflateEnd(&stream_);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  bool ready() const { return ready_; }
  z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
  bool ready_ = false;
};

uInt portion(size_t bytes) {
  return static_cast<uInt>(std::min<size_t>(bytes, std::numeric_limits<uInt>::max() / 2));
}

}  // namespace

bool is_gzip(std::span<const std::byte> bytes) {
  return bytes.size() >= 3 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x8B} &&
         bytes[2] == std::byte{8};
}

Result<Bytes> gunzip(std::span<const std::byte> bytes, size_t limit) {
  Inflater inflater;
  if (!inflater.ready()) return Error{"there is no memory to unpack it"};
  z_stream& stream = inflater.stream();
  auto out = std::make_shared<std::vector<std::byte>>();
  size_t taken = 0;
  size_t made = 0;
  while (true) {
    if (made == out->size()) {
      if (made >= limit) {
        return Error{"it unpacks to more than " + std::to_string(limit) +
                     " bytes, which is more than is expected of so small a file"};
      }
      out->resize(std::min(limit, std::max(kFirstRoom, 2 * made)));
    }
    const uInt input = portion(bytes.size() - taken);
    const uInt room = portion(out->size() - made);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + taken));
    stream.avail_in = input;
    stream.next_out = reinterpret_cast<Bytef*>(out->data() + made);
    stream.avail_out = room;
    const int state = inflate(&stream, Z_NO_FLUSH);
    taken += input - stream.avail_in;
    made += room - stream.avail_out;
    if (state == Z_STREAM_END) {
      const auto rest = bytes.subspan(taken);
      const bool padding =
          std::all_of(rest.begin(), rest.end(), [](std::byte b) { return b == std::byte{0}; });
      if (padding) {
        out->resize(made);
        return Bytes{out, *out};
      }
      if (!is_gzip(rest)) return Error{"its packed data is followed by something else"};
      inflateReset(&stream);
      continue;
    }
    if (state != Z_OK && state != Z_BUF_ERROR) return Error{"its packed data is damaged"};
    // With room left it has put out all that there is of what it was given.
    if (taken == bytes.size() && stream.avail_out > 0) {
      return Error{"its packed data ends too early"};
    }
  }
}

Result<Bytes> open_unpacked(AssetResolver& assets, const std::string& reference) {
  const Result<Bytes> bytes = assets.open(reference);
  if (!bytes || !is_gzip(bytes->span())) return bytes;
  auto plain = gunzip(bytes->span(), unpacked_limit(bytes->size()));
  if (!plain) return plain.error().in(reference);
  return plain;
}

}  // namespace hyades::core
