#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/film/film_exr.h"
#include "core/film/film_exr_channels.h"
#include "core/film/film_exr_ids.h"
#include "core/film/film_header.h"
#include "core/image/exr_support.h"

namespace hyades::core {
namespace {

constexpr uint32_t kExrMagic = 20000630;
constexpr uint64_t kMostPixelsPerByte =
    4096;  // ZIP reaches 1032, half of the words may be left out
constexpr ImageLimits kLimits{1 << 20, size_t{1} << 33U};

const Error kNoFilm{"it is an OpenEXR file, but no film of Hyades (there is no part \"sums\")"};

std::optional<std::string> text_attribute(const Imf::Header& header, const char* name) {
  const auto* const attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
  return attribute != nullptr ? std::optional(attribute->value()) : std::nullopt;
}

/// Which of the words are there; an error for channels that do not belong to such a film.
Result<std::vector<WordChannel>> present_words(const Imf::ChannelList& channels,
                                               const FilmLayout& layout, const IdRows& ids) {
  std::vector<WordChannel> words = word_channels(layout);
  size_t count = 0;
  for (auto i = channels.begin(); i != channels.end(); ++i, ++count) {
    const Imf::Channel& channel = i.channel();
    const bool known =
        std::any_of(words.begin(), words.end(),
                    [&](const WordChannel& word) { return word.name == i.name(); }) ||
        std::find(ids.names().begin(), ids.names().end(), i.name()) != ids.names().end();
    if (!known || channel.type != Imf::UINT || channel.xSampling != 1 || channel.ySampling != 1) {
      return Error{fmt::format("channel '{}' does not belong into this film", i.name())};
    }
  }
  std::erase_if(words, [&](const WordChannel& word) {
    return !word.required && channels.findChannel(word.name) == nullptr;
  });
  for (const WordChannel& word : words) {
    if (channels.findChannel(word.name) == nullptr) {
      return Error{fmt::format("channel '{}' is missing", word.name)};
    }
  }
  return words;
}

/// An opened film file and what it says of itself.
struct Opened {
  std::unique_ptr<MemoryIStream> stream;
  std::unique_ptr<Imf::MultiPartInputFile> in;
  int part = 0;
  std::string facts;
  std::string digest;
  FilmHeader header;
};

Result<Opened> open_parts(std::span<const std::byte> bytes) {
  prepare_openexr();
  uint32_t magic = 0;
  if (bytes.size() >= sizeof magic) std::memcpy(&magic, bytes.data(), sizeof magic);
  if (magic != kExrMagic) return Error{"it is no OpenEXR file"};
  if (const Status header = check_exr_header(bytes, kLimits); !header) return header.error();
  Opened opened;
  opened.stream = std::make_unique<MemoryIStream>(bytes);
  opened.in = std::make_unique<Imf::MultiPartInputFile>(*opened.stream, 0, false);
  const Imf::MultiPartInputFile& in = *opened.in;
  while (opened.part < in.parts() &&
         (!in.header(opened.part).hasName() || in.header(opened.part).name() != kSumsPart)) {
    ++opened.part;
  }
  if (opened.part == in.parts()) return kNoFilm;
  const Imf::Header& part_header = in.header(opened.part);
  const std::optional<std::string> facts = text_attribute(part_header, kFilmAttribute);
  const std::optional<std::string> digest = text_attribute(part_header, kDigestAttribute);
  if (!facts || !digest || !part_header.hasType() || part_header.type() != Imf::SCANLINEIMAGE) {
    return kNoFilm;
  }
  Result<FilmHeader> header = parse_film_header(*facts);
  if (!header) return header.error();
  opened.facts = *facts;
  opened.digest = *digest;
  opened.header = std::move(*header);
  return opened;
}

Result<FilmFile> read_parts(std::span<const std::byte> bytes) {
  Result<Opened> opened = open_parts(bytes);
  if (!opened) return opened.error();
  Imf::MultiPartInputFile& in = *opened->in;
  const int index = opened->part;
  const Imf::Header& part_header = in.header(index);
  FilmHeader* const header = &opened->header;
  const PixelRect& window = header->window;
  if (part_header.dataWindow() !=
      Imath::Box2i({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1})) {
    return Error{"its data window is not the film's"};
  }
  FilmLayout layout = make_film_layout(header->layers);
  IdRows ids(layout, window, part_header.channels());
  Result<std::vector<WordChannel>> words = present_words(part_header.channels(), layout, ids);
  if (!words) return words.error();
  if (film_memory(layout, window) / kMostPixelsPerByte > bytes.size()) {
    return Error{fmt::format("it claims {} x {} pixels, which {} bytes cannot hold", window.width(),
                             window.height(), bytes.size())};
  }

  FilmFile file{std::move(header->info), Film(std::move(layout), window)};
  if (file.film.layout().layers.splats) file.film.mutable_splats().spread();
  for (PartSplatLayer& part : file.film.mutable_part_splats()) part.spread();
  Imf::FrameBuffer buffer;
  for (const WordChannel& word : *words) buffer.insert(word.name, word_slice(file.film, word));
  Imf::InputPart part(in, index);
  ids.insert(buffer);
  part.setFrameBuffer(buffer);
  if (ids.names().empty()) {
    part.readPixels(window.y0, window.y1 - 1);
  } else {
    for (int y = window.y0; y < window.y1; ++y) {
      part.readPixels(y);
      if (!ids.take(y, file.film)) return Error{"its ids are damaged"};
    }
  }
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    for (const auto& [id, name] : header->names[static_cast<size_t>(kind)])
      file.film.mutable_ids(kind).name(id, name);
  }

  file.film.mutable_coverage() = std::move(header->coverage);
  if (const Status agrees = file.film.check(); !agrees) return agrees.error();
  if (film_file_digest(opened->facts, file.film) != opened->digest) {
    return Error{"it is damaged: its digest does not match"};
  }
  return file;
}

}  // namespace

namespace {

/// What `read` returns or throws, in words that name the file.
template <class Read>
auto in_words(const std::string& name, const Read& read) -> decltype(read()) {
  const std::string context = "cannot read " + name;
  try {
    auto result = read();
    if (!result) return result.error().in(context);
    return result;
  } catch (const std::bad_alloc&) {
    return Error{context + ": there is not enough memory for it"};
  } catch (const std::exception& e) {
    return Error{context + ": it is damaged: " + e.what()};
  }
}

}  // namespace

Result<FilmFile> read_film_exr(const Bytes& bytes, const std::string& name) {
  return in_words(name, [&] { return read_parts(bytes.span()); });
}

Result<FilmFile> read_film_exr(const std::string& path) {
  const Result<Bytes> bytes = map_file(path);
  if (!bytes) return bytes.error().in("cannot read " + path);
  return read_film_exr(*bytes, path);
}

Result<uint64_t> film_exr_memory(const Bytes& bytes, const std::string& name) {
  return in_words(name, [&]() -> Result<uint64_t> {
    const Result<Opened> opened = open_parts(bytes.span());
    if (!opened) return opened.error();
    return film_memory(make_film_layout(opened->header.layers), opened->header.window);
  });
}

Result<FilmInfo> read_film_info(const std::string& path) {
  const Result<Bytes> bytes = map_file(path);
  if (!bytes) return bytes.error().in("cannot read " + path);
  return in_words(path, [&]() -> Result<FilmInfo> {
    Result<Opened> opened = open_parts(bytes->span());
    if (!opened) return opened.error();
    return std::move(opened->header.info);
  });
}

}  // namespace hyades::core
