#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/image/exr_support.h"
#include "core/image/write_image.h"

namespace hyades::core {
namespace {

constexpr float kLargestHalf = 65504.0F;

Status check(const Image& image, const ImageMetadata& metadata) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty()) {
    return Error{"the picture is empty"};
  }
  for (const auto& name : image.channels) {
    if (name.empty() || name.size() > 255) return Error{"a channel name is empty or too long"};
    if (std::count(image.channels.begin(), image.channels.end(), name) > 1) {
      return Error{fmt::format("two channels are named '{}'", name)};
    }
  }
  for (const auto& [name, value] : metadata) {
    if (name.empty() || name.size() > 255) {
      return Error{fmt::format("metadata name '{}' is empty or too long", name.substr(0, 40))};
    }
  }
  return {};
}

/// Whether a channel's bits are ids of Cryptomatte, which mean nothing as 16-bit numbers.
bool holds_ids(const std::string& channel) {
  return channel.starts_with("Crypto") || channel.ends_with(".ID");
}

/// Infinity stays; what is finite stays finite.
half to_half(float value) {
  if (std::isfinite(value)) value = std::clamp(value, -kLargestHalf, kLargestHalf);
  return half(value);
}

Imath::Box2i data_window(const Image& image) {
  const Imath::V2i first(image.placement.x, image.placement.y);
  return {first, first + Imath::V2i(image.width - 1, image.height - 1)};
}

Imath::Box2i display_window(const Image& image) {
  const ImageWindow& place = image.placement;
  if (!place.in_frame()) return data_window(image);
  return {{0, 0}, {place.frame_width - 1, place.frame_height - 1}};
}

/// `place` is the path of a file, or a stream.
template <class Place>
void write(Place& place, const Image& image, const ImageMetadata& metadata, bool as_half) {
  prepare_openexr();
  const Imath::Box2i window = data_window(image);
  Imf::Header header(display_window(image), window);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec.709
  for (const auto& [name, value] : metadata) header.insert(name, Imf::StringAttribute(value));
  const auto type_of = [&](const std::string& name) {
    return as_half && !holds_ids(name) ? Imf::HALF : Imf::FLOAT;
  };
  for (const auto& name : image.channels)
    header.channels().insert(name, Imf::Channel(type_of(name)));

  std::vector<half> halves;
  if (as_half) {
    halves.resize(image.data.size());
    std::transform(image.data.begin(), image.data.end(), halves.begin(), to_half);
  }
  Imf::FrameBuffer buffer;
  for (size_t c = 0; c < image.channels.size(); ++c) {
    const Imf::PixelType type = type_of(image.channels[c]);
    const bool is_half = type == Imf::HALF;
    const void* const first = is_half ? static_cast<const void*>(halves.data() + c)
                                      : static_cast<const void*>(image.data.data() + c);
    const size_t pixel_bytes = image.channels.size() * (is_half ? sizeof(half) : sizeof(float));
    buffer.insert(image.channels[c],
                  Imf::Slice::Make(type, first, window, pixel_bytes,
                                   pixel_bytes * static_cast<size_t>(image.width)));
  }
  Imf::OutputFile file(place, header, 0);
  file.setFrameBuffer(buffer);
  file.writePixels(image.height);
}

/// OpenEXR's output into memory.
class MemoryOStream : public Imf::OStream {
 public:
  explicit MemoryOStream(std::vector<std::byte>& bytes)
      : Imf::OStream("a picture in memory"), bytes_(bytes) {}

  void write(const char c[], int n) override {
    const size_t end = at_ + static_cast<size_t>(n);
    if (bytes_.size() < end) bytes_.resize(end);
    std::copy_n(reinterpret_cast<const std::byte*>(c), n,
                bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = end;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }

 private:
  std::vector<std::byte>& bytes_;
  uint64_t at_ = 0;
};

}  // namespace

Result<Bytes> encode_exr(const Image& image, const ImageMetadata& metadata, bool half) {
  if (const Status status = check(image, metadata); !status) {
    return status.error().in("cannot write a picture");
  }
  auto bytes = std::make_shared<std::vector<std::byte>>();
  try {
    MemoryOStream stream(*bytes);
    write(stream, image, metadata, half);
  } catch (const std::exception& e) {
    return Error{std::string("cannot write a picture: ") + e.what()};
  }
  const std::span<const std::byte> view(*bytes);
  return Bytes(std::move(bytes), view);
}

Status write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata,
                 bool half) {
  if (const Status status = check(image, metadata); !status) {
    return status.error().in("cannot write " + path);
  }
  return replace_file(path, [&](const std::string& temporary) -> Status {
    try {
      const char* const name = temporary.c_str();
      write(name, image, metadata, half);
      return {};
    } catch (const std::exception& e) {
      return Error{"cannot write " + path + ": " + e.what()};
    }
  });
}

}  // namespace hyades::core
