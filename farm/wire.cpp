#include "farm/wire.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::farm {
namespace {

constexpr int64_t kMostPixels = int64_t{1} << 24;

}  // namespace

v1::PixelRect to_wire(const core::PixelRect& rect) {
  v1::PixelRect wire;
  wire.set_x0(rect.x0);
  wire.set_y0(rect.y0);
  wire.set_x1(rect.x1);
  wire.set_y1(rect.y1);
  return wire;
}

v1::Unit to_wire(const core::Unit& unit) {
  v1::Unit wire;
  wire.set_frame(unit.frame);
  *wire.mutable_tile() = to_wire(unit.tile);
  wire.set_first_batch(unit.batches.first);
  wire.set_batches(unit.batches.count);
  return wire;
}

std::string to_wire(const core::Sha256& digest) { return {digest.begin(), digest.end()}; }

v1::FilmHeader to_wire(const core::FilmInfo& info) {
  v1::FilmHeader wire;
  wire.set_job_name(info.job_name);
  wire.set_render_key(info.render_key);
  wire.set_frame(info.frame);
  wire.set_width(info.width);
  wire.set_height(info.height);
  *wire.mutable_crop() = to_wire(info.crop);
  wire.set_samples(info.samples);
  wire.set_noise(info.aim.noise);
  wire.set_noise_exposure(info.aim.exposure);
  wire.set_min_samples(info.aim.min_samples);
  wire.set_worker_class(info.worker_class);
  wire.set_build(info.build);
  return wire;
}

core::Result<core::PixelRect> from_wire(const v1::PixelRect& wire) {
  const int64_t width = int64_t{wire.x1()} - wire.x0();
  const int64_t height = int64_t{wire.y1()} - wire.y0();
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels) {
    return core::Error{fmt::format("{},{} to {},{} is no rectangle of pixels", wire.x0(), wire.y0(),
                                   wire.x1(), wire.y1())};
  }
  return core::PixelRect{wire.x0(), wire.y0(), wire.x1(), wire.y1()};
}

core::Result<core::Unit> from_wire(const v1::Unit& wire) {
  const auto tile = from_wire(wire.tile());
  if (!tile) return tile.error();
  if (wire.batches() == 0 ||
      uint64_t{wire.first_batch()} + wire.batches() > uint64_t{core::kMaxBatches}) {
    return core::Error{
        fmt::format("{} batches from {} on: no job has these", wire.batches(), wire.first_batch())};
  }
  return core::Unit{wire.frame(), *tile, {wire.first_batch(), wire.batches()}};
}

core::Result<core::Sha256> digest_from_wire(const std::string& bytes) {
  core::Sha256 digest{};
  if (bytes.size() != digest.size()) {
    return core::Error{fmt::format("a SHA-256 has 32 bytes, not {}", bytes.size())};
  }
  std::copy(bytes.begin(), bytes.end(), digest.begin());
  return digest;
}

core::Result<core::FilmInfo> from_wire(const v1::FilmHeader& wire) {
  const auto crop = from_wire(wire.crop());
  if (!crop) return crop.error();
  core::FilmInfo info;
  info.job_name = wire.job_name();
  info.render_key = wire.render_key();
  info.frame = wire.frame();
  info.width = wire.width();
  info.height = wire.height();
  info.crop = *crop;
  info.samples = wire.samples();
  info.aim = {wire.noise(), wire.noise_exposure(), wire.min_samples()};
  info.worker_class = wire.worker_class();
  info.build = wire.build();
  return info;
}

std::string hex_from_wire(const std::string& bytes) {
  return core::to_hex({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

core::Result<core::Sha256> digest_from_hex(const std::string& hex) {
  core::Sha256 digest{};
  const auto value = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
  };
  if (hex.size() != 2 * digest.size()) {
    return core::Error{fmt::format("a SHA-256 has 64 hexadecimal digits, not {}", hex.size())};
  }
  for (size_t i = 0; i < digest.size(); ++i) {
    const int high = value(hex[2 * i]);
    const int low = value(hex[2 * i + 1]);
    if (high < 0 || low < 0) return core::Error{"'" + hex + "' is not hexadecimal"};
    digest[i] = static_cast<uint8_t>(16 * high + low);
  }
  return digest;
}

std::string wire_text(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    size_t size = core::utf8_length(text);
    if (clean.size() + std::max<size_t>(size, 1) > kMaxTextBytes) break;
    if (size == 0) {
      clean += '?';
      size = 1;
    } else {
      clean += text.substr(0, size);
    }
    text.remove_prefix(size);
  }
  return clean;
}

}  // namespace hyades::farm
