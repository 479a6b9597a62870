#include "core/film/film_exr_channels.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/base/hash.h"

namespace hyades::core {

static_assert(sizeof(Fixed128) == 16 && offsetof(Fixed128, low) == 0 &&
                  offsetof(Fixed128, high) == 8,
              "the four words of a sum lie one after the other, lowest first");
static_assert(offsetof(SplatSums, value) == 0 && offsetof(SplatSums, square) == 48 &&
                  sizeof(PartSums) == 48,
              "sums lie one after the other");

std::vector<WordChannel> word_channels(const FilmLayout& layout) {
  std::vector<WordChannel> words;
  for (size_t c = 0; c < layout.channels.size(); ++c) {
    const FilmChannel& channel = layout.channels[c];
    const auto index = static_cast<int>(c);
    if (channel.rule == MergeRule::min) {
      words.push_back({channel.name + ".min", index, 0, true});
      continue;
    }
    // The words around the binary point are always there, so that a film's size in memory stays in
    // proportion to that of its file.
    for (int word = 0; word < 4; ++word) {
      words.push_back(
          {channel.name + ".sum" + std::to_string(word), index, word, word == 1 || word == 2});
    }
  }
  if (!layout.layers.splats) return words;
  auto index = static_cast<int>(layout.channels.size());
  std::vector<std::string> sums = {"splats", "splats.square"};
  for (const std::string& part : layout.part_names) sums.push_back("splats." + part);
  for (const std::string& sum : sums) {
    for (const char* channel : {"R", "G", "B"}) {
      for (int word = 0; word < 4; ++word) {
        words.push_back(
            {fmt::format("{}.{}.sum{}", sum, channel, word), index, word, word == 1 || word == 2});
      }
      ++index;
    }
  }
  return words;
}

namespace {

/// The sums of a word's channel as the film keeps them: `stride` bytes from pixel to pixel.
struct Sums {
  const std::byte* first = nullptr;
  size_t stride = 0;
};

Sums sums_of(const Film& film, int channel) {
  const auto planes = static_cast<int>(film.layout().channels.size());
  if (channel < planes) return {std::as_bytes(film.plane(channel)).data(), sizeof(Fixed128)};
  const auto splat = static_cast<size_t>(channel - planes);
  constexpr size_t kOfBeauty = sizeof(SplatSums) / sizeof(Fixed128);
  if (splat < kOfBeauty) {
    return {std::as_bytes(film.splats().all()).data() + sizeof(Fixed128) * splat,
            sizeof(SplatSums)};
  }
  const size_t value = splat - kOfBeauty;
  return {
      std::as_bytes(film.part_splats()[value / 3].all()).data() + sizeof(Fixed128) * (value % 3),
      sizeof(PartSums)};
}

}  // namespace

Imf::Slice word_slice(const Film& film, const WordChannel& word) {
  const PixelRect& w = film.window();
  const Sums sums = sums_of(film, word.channel);
  const std::byte* const base = sums.first + 4 * static_cast<ptrdiff_t>(word.word);
  // OpenEXR has one slice type for reading and writing; writing files leaves the bytes alone.
  return Imf::Slice::Make(Imf::UINT, const_cast<std::byte*>(base),
                          Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}), sums.stride,
                          sums.stride * static_cast<size_t>(w.width()));
}

bool is_zero(const Film& film, const WordChannel& word) {
  const Sums sums = sums_of(film, word.channel);
  const std::byte* at = sums.first + 4 * static_cast<ptrdiff_t>(word.word);
  for (int64_t i = 0; i < film.window().area(); ++i, at += sums.stride) {
    uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    if (value != 0) return false;
  }
  return true;
}

std::string film_file_digest(const std::string& header, const Film& film) {
  return to_hex(sha256(header + film.digest()));
}

}  // namespace hyades::core
