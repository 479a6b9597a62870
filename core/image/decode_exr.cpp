#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "core/base/color.h"
#include "core/image/decoders.h"
#include "core/image/exr_support.h"

namespace hyades::core {
namespace {

/// R, G, B, A and Y come first, in this order; the rest follows by name.
int rank(const std::string& channel) {
  const std::string first = "RGBAY";
  const size_t place = channel.size() == 1 ? first.find(channel) : std::string::npos;
  return place == std::string::npos ? static_cast<int>(first.size()) : static_cast<int>(place);
}

bool is_alpha(const std::string& channel) {
  return channel == "A" || (channel.size() > 2 && channel.ends_with(".A"));
}

/// Where the data window lies in a display window that holds it; nowhere in particular where they
/// are equal, or where pixels lie outside (overscan).
ImageWindow placement_in(const Imath::Box2i& display, const Imath::Box2i& data) {
  if (data == display || !display.intersects(data.min) || !display.intersects(data.max)) return {};
  const Imath::V2i place = data.min - display.min;
  return {place.x, place.y, display.max.x - display.min.x + 1, display.max.y - display.min.y + 1};
}

Result<Image> decode(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  prepare_openexr();
  if (const Status header = check_exr_header(file, limits); !header) return header.error();
  MemoryIStream stream(file);
  // No reconstruction of a broken table of offsets: such a file is damaged.
  Imf::MultiPartInputFile parts(stream, 0, false);
  const Imf::Header& header = parts.header(0);
  if (header.hasType() && Imf::isDeepData(header.type())) {
    return Error{"deep pictures are not read"};
  }
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  const int64_t height = int64_t{window.max.y} - window.min.y + 1;

  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
      return Error{fmt::format("channel '{}' is subsampled, which is not read", i.name())};
    }
    names.emplace_back(i.name());
  }
  if (names.empty()) return Error{"no channels"};
  const auto count = static_cast<int64_t>(names.size());
  if (const Status size = check_image_size(width, height, count, limits); !size) {
    return size.error();
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return rank(a) < rank(b); });

  Image image = make_image(static_cast<int>(width), static_cast<int>(height), names);
  image.placement = placement_in(header.displayWindow(), window);
  const size_t pixel_bytes = names.size() * sizeof(float);
  Imf::FrameBuffer buffer;
  for (size_t c = 0; c < names.size(); ++c) {
    buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, pixel_bytes,
                                             pixel_bytes * static_cast<size_t>(width)));
  }
  Imf::InputPart part(parts, 0);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);

  if (srgb) {
    for (size_t i = 0; i < image.data.size(); ++i) {
      if (!is_alpha(names[i % names.size()])) image.data[i] = srgb_decode(image.data[i]);
    }
  }
  return image;
}

}  // namespace

Result<Image> decode_exr(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  try {
    return decode(file, srgb, limits);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return Error{e.what()};
  }
}

}  // namespace hyades::core
