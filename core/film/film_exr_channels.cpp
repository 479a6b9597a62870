#include "core/film/film_exr_channels.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/base/hash.h"

namespace hyades::core {

static_assert(sizeof(Fixed128) == 16 && offsetof(Fixed128, low) == 0 &&
                  offsetof(Fixed128, high) == 8,
              "the four words of a sum lie one after the other, lowest first");
static_assert(offsetof(SplatLayer::Sums, value) == 0 && offsetof(SplatLayer::Sums, square) == 48,
              "six sums lie one after the other");

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
  for (const char* sum : {"splats.", "splats.square."}) {
    for (const char* channel : {"R", "G", "B"}) {
      for (int word = 0; word < 4; ++word) {
        words.push_back(
            {fmt::format("{}{}.sum{}", sum, channel, word), index, word, word == 1 || word == 2});
      }
      ++index;
    }
  }
  return words;
}

Imf::Slice word_slice(const Film& film, const WordChannel& word) {
  const PixelRect& w = film.window();
  const auto planes = static_cast<int>(film.layout().channels.size());
  const bool splat = word.channel >= planes;
  const std::byte* base = splat ? std::as_bytes(film.splats().all()).data() +
                                      sizeof(Fixed128) * static_cast<size_t>(word.channel - planes)
                                : std::as_bytes(film.plane(word.channel)).data();
  base += 4 * static_cast<ptrdiff_t>(word.word);
  const size_t pixel = splat ? sizeof(SplatLayer::Sums) : sizeof(Fixed128);
  // OpenEXR has one slice type for reading and writing; writing files leaves the bytes alone.
  return Imf::Slice::Make(Imf::UINT, const_cast<std::byte*>(base),
                          Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}), pixel,
                          pixel * static_cast<size_t>(w.width()));
}

bool is_zero(const Film& film, const WordChannel& word) {
  const auto none = [&](const Fixed128& value) {
    return static_cast<uint32_t>(value.raw() >> (32 * word.word)) == 0;
  };
  const auto planes = static_cast<int>(film.layout().channels.size());
  if (word.channel < planes) {
    const std::span<const Fixed128> plane = film.plane(word.channel);
    return std::all_of(plane.begin(), plane.end(), none);
  }
  const auto c = static_cast<size_t>(word.channel - planes);
  const std::span<const SplatLayer::Sums> all = film.splats().all();
  return std::all_of(all.begin(), all.end(), [&](const SplatLayer::Sums& sums) {
    return none(c < 3 ? sums.value[c] : sums.square[c - 3]);
  });
}

std::string film_file_digest(const std::string& header, const Film& film) {
  return to_hex(sha256(header + film.digest()));
}

}  // namespace hyades::core
