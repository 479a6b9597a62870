#include "core/film/film_exr_channels.h"

#include <Imath/ImathBox.h>

#include <cstddef>

#include "core/base/hash.h"

namespace hyades::core {

static_assert(sizeof(Fixed128) == 16 && offsetof(Fixed128, low) == 0 &&
                  offsetof(Fixed128, high) == 8,
              "the four words of a sum lie one after the other, lowest first");

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
  return words;
}

Imf::Slice word_slice(const Film& film, const WordChannel& word) {
  const PixelRect& w = film.window();
  const std::byte* const base =
      std::as_bytes(film.plane(word.channel)).data() + 4 * static_cast<ptrdiff_t>(word.word);
  // OpenEXR has one slice type for reading and writing; writing files leaves the bytes alone.
  return Imf::Slice::Make(Imf::UINT, const_cast<std::byte*>(base),
                          Imath::Box2i({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}), sizeof(Fixed128),
                          sizeof(Fixed128) * static_cast<size_t>(w.width()));
}

std::string film_file_digest(const std::string& header, const Film& film) {
  return to_hex(sha256(header + film.digest()));
}

}  // namespace hyades::core
