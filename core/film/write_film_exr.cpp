#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/film/film_exr.h"
#include "core/film/film_exr_channels.h"
#include "core/film/film_exr_ids.h"
#include "core/film/film_header.h"
#include "core/image/exr_support.h"

namespace hyades::core {
namespace {

Imath::Box2i box_of(const PixelRect& r) { return {{r.x0, r.y0}, {r.x1 - 1, r.y1 - 1}}; }

Imf::Header part_header(const char* name, const FilmFile& file) {
  Imf::Header header(box_of({0, 0, file.info.width, file.info.height}), box_of(file.film.window()));
  header.setName(name);
  header.setType(Imf::SCANLINEIMAGE);
  header.compression() = Imf::ZIP_COMPRESSION;
  // The fastest level: measured on noisy sums, a tenth quicker and 2 % larger than the usual one.
  header.zipCompressionLevel() = 1;
  return header;
}

void write_picture(Imf::MultiPartOutputFile& out, const Image& picture, const PixelRect& window) {
  Imf::FrameBuffer buffer;
  const size_t pixel_bytes = sizeof(float) * picture.channels.size();
  for (size_t c = 0; c < picture.channels.size(); ++c) {
    buffer.insert(
        picture.channels[c],
        Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(picture.data.data() + c), box_of(window),
                         pixel_bytes, pixel_bytes * static_cast<size_t>(picture.width)));
  }
  Imf::OutputPart part(out, 0);
  part.setFrameBuffer(buffer);
  part.writePixels(picture.height);
}

void write_sums(Imf::MultiPartOutputFile& out, const Film& film,
                const std::vector<WordChannel>& words) {
  Imf::FrameBuffer buffer;
  for (const WordChannel& word : words) buffer.insert(word.name, word_slice(film, word));
  IdRows ids(film);
  ids.insert(buffer);
  Imf::OutputPart part(out, 1);
  part.setFrameBuffer(buffer);
  if (ids.names().empty()) return part.writePixels(film.window().height());
  for (int y = film.window().y0; y < film.window().y1; ++y) {
    ids.fill(film, y);
    part.writePixels(1);
  }
}

void write_parts(const std::string& path, const FilmFile& file, const ImageMetadata& extra) {
  prepare_openexr();
  const Image picture = file.film.normalised();
  Imf::Header headers[2] = {part_header(kPicturePart, file), part_header(kSumsPart, file)};
  for (const auto& [name, value] : extra) headers[0].insert(name, Imf::StringAttribute(value));
  for (const std::string& name : picture.channels) {
    headers[0].channels().insert(name, Imf::Channel(Imf::FLOAT));
  }

  const std::string facts = write_film_header(file);
  headers[1].insert(kFilmAttribute, Imf::StringAttribute(facts));
  headers[1].insert(kDigestAttribute, Imf::StringAttribute(film_file_digest(facts, file.film)));
  std::vector<WordChannel> words = word_channels(file.film.layout());
  std::erase_if(
      words, [&](const WordChannel& word) { return !word.required && is_zero(file.film, word); });
  for (const WordChannel& word : words) {
    headers[1].channels().insert(word.name, Imf::Channel(Imf::UINT));
  }

  const IdRows ids(file.film);
  for (const std::string& name : ids.names())
    headers[1].channels().insert(name, Imf::Channel(Imf::UINT));
  Imf::MultiPartOutputFile out(path.c_str(), headers, 2, false, 0);
  write_picture(out, picture, file.film.window());
  write_sums(out, file.film, words);
}

/// A film with splats as a file holds it: they lie in all of the region, so that the window is
/// that.
Film over_region(const Film& film) {
  Film whole(film.layout(), film.splats().region());
  whole.mutable_splats().spread();
  for (PartSplatLayer& part : whole.mutable_part_splats()) part.spread();
  if (!whole.merge(film)) std::abort();  // an empty film of the same region
  return whole;
}

Status write_file(const std::string& path, const FilmFile& file, const ImageMetadata& extra,
                  const std::string& context) {
  return replace_file(path, [&](const std::string& temporary) -> Status {
    try {
      write_parts(temporary, file, extra);
      return {};
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      return Error{context + ": " + e.what()};
    }
  });
}

/// Whether a film with splats is over_region already.
bool lies_everywhere(const Film& film) {
  const std::span<const PartSplatLayer> parts = film.part_splats();
  return film.window() == film.splats().region() && !film.splats().all().empty() &&
         std::none_of(parts.begin(), parts.end(),
                      [](const PartSplatLayer& part) { return part.all().empty(); });
}

/// Names that would change what the file is.
bool is_reserved(const std::string& name) {
  static const Imf::Header kStandard;
  return name.empty() || name.size() > 255 || name.starts_with("hyades.") || name == "name" ||
         name == "type" || name == "view" || name == "version" || name == "chunkCount" ||
         kStandard.find(name) != kStandard.end();
}

}  // namespace

Status write_film_exr(const std::string& path, const FilmFile& file, const ImageMetadata& extra) {
  const std::string context = "cannot write " + path;
  if (const Status fits = check_film_frame(file.info, file.film.window()); !fits) {
    return fits.error().in(context);
  }
  for (const auto& [name, value] : extra) {
    if (is_reserved(name)) return Error{context + ": '" + name + "' is no name for metadata"};
  }
  if (file.film.layout().layers.splats && !lies_everywhere(file.film)) {
    const FilmFile whole{file.info, over_region(file.film)};
    if (const Status fits = check_film_frame(file.info, whole.film.window()); !fits) {
      return fits.error().in(context);
    }
    return write_file(path, whole, extra, context);
  }
  return write_file(path, file, extra, context);
}

}  // namespace hyades::core
