#include "core/import/pbrt/scene_files.h"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/text.h"

namespace hyades::core::pbrt {

Result<Bytes> without_gzip(const Bytes& bytes, size_t most) {
  const std::span<const std::byte> in = bytes.span();
  if (in.size() < 2 || in[0] != std::byte{0x1F} || in[1] != std::byte{0x8B}) return bytes;
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return Error{"gzip cannot be unpacked"};
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closed(&stream, inflateEnd);
  auto out = std::make_shared<std::vector<std::byte>>();
  // A byte of deflate makes 1032 at most.
  out->reserve(std::min(most, 8 * in.size()));
  std::vector<std::byte> piece(size_t{1} << 18);
  size_t taken = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      const size_t n = std::min<size_t>(in.size() - taken, size_t{1} << 30);
      if (n == 0) return Error{"the gzip data is cut off"};
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data() + taken));
      stream.avail_in = static_cast<uInt>(n);
      taken += n;
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = inflate(&stream, Z_NO_FLUSH);
    if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) {
      return Error{"the gzip data is damaged"};
    }
    const size_t made = piece.size() - stream.avail_out;
    if (made > most - out->size()) {
      return Error{"it unpacks to more than " + format_bytes(most)};
    }
    out->insert(out->end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(made));
  }
  const std::span<const std::byte> view(*out);
  return Bytes(std::move(out), view);
}

SceneFiles::SceneFiles(AssetResolver& files, std::string main)
    : files_(files), main_(std::move(main)) {}

Result<std::string> SceneFiles::inside(const std::string& reference) {
  if (reference.empty()) return Error{"the name of the file is empty"};
  if (reference.front() == '/' || reference.find('\0') != std::string::npos) {
    return Error{"'" + reference + "' is not a path in the scene's folder"};
  }
  const std::string folded = resolve_reference(reference);
  if (folded == ".." || folded.starts_with("../")) {
    return Error{"'" + reference + "' leaves the scene's folder"};
  }
  return folded;
}

Result<Bytes> SceneFiles::open(const std::string& reference) const {
  auto path = inside(reference);
  if (!path) return path.error();
  auto bytes = files_.open(*path, main_);
  if (!bytes) return bytes.error();
  auto plain = without_gzip(*bytes, kMostUnpacked);
  if (!plain) return plain.error().in(*path);
  return plain;
}

bool SceneFiles::exists(const std::string& reference) const {
  auto path = inside(reference);
  return path.ok() && files_.exists(resolve_reference(*path, main_));
}

}  // namespace hyades::core::pbrt
