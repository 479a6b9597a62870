#include "core/finish/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace hyades::core {
namespace {

struct Row {
  IdKind kind;
  const char* id;      ///< channel of the id that covers most
  const char* layer;   ///< in a job
  const char* crypto;  ///< in files
};
constexpr Row kRows[] = {
    {IdKind::object, "object_id.ID", "crypto_object", "CryptoObject"},
    {IdKind::material, "material_id.ID", "crypto_material", "CryptoMaterial"},
};

constexpr size_t kPerKind = 1 + 2 * static_cast<size_t>(kCryptomatteRanks);

bool holds(const Film& film, const Row& row) {
  return film.layout().layers.ids[static_cast<size_t>(row.kind)];
}

void append_names(const Row& row, std::vector<std::string>& names) {
  names.emplace_back(row.id);
  for (int rank = 0; rank < kCryptomatteRanks; ++rank) {
    const char* const channels = rank % 2 == 0 ? "RG" : "BA";
    for (int i = 0; i < 2; ++i)
      names.push_back(fmt::format("{}{:02}.{}", row.crypto, rank / 2, channels[i]));
  }
}

/// One pixel's channels, in the order of append_names. `ids` is scratch.
void fill(std::span<const IdCount> held, std::vector<IdCount>& ids, float* out) {
  ids.assign(held.begin(), held.end());
  double all = 0.0;
  for (const IdCount& entry : ids) all += entry.count;
  std::erase_if(ids, [](const IdCount& entry) { return entry.id == IdLayer::kNothing; });
  std::sort(ids.begin(), ids.end(), [](const IdCount& a, const IdCount& b) {
    return a.count != b.count ? a.count > b.count : a.id < b.id;
  });
  std::fill_n(out, kPerKind, 0.0F);
  if (ids.empty()) return;
  out[0] = std::bit_cast<float>(ids[0].id);
  const size_t ranks = std::min(ids.size(), static_cast<size_t>(kCryptomatteRanks));
  for (size_t i = 0; i < ranks; ++i) {
    out[1 + 2 * i] = std::bit_cast<float>(ids[i].id);
    out[2 + 2 * i] = static_cast<float>(ids[i].count / all);
  }
}

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string manifest(const IdLayer& ids) {
  std::string text;
  for (const auto& [id, name] : ids.names())
    text += fmt::format("{}{}:\"{:08x}\"", text.empty() ? "{" : ",", json_text(name), id);
  return text.empty() ? "{}" : text + '}';
}

}  // namespace

void add_id_channels(const Film& film, Image& picture) {
  if (!film.layout().layers.has_ids()) return;
  std::vector<std::string> names = picture.channels;
  for (const Row& row : kRows) {
    if (holds(film, row)) append_names(row, names);
  }
  Image all = make_image(picture.width, picture.height, std::move(names));
  all.placement = picture.placement;
  const size_t old = picture.channels.size();
  const size_t stride = all.channels.size();
  const PixelRect& window = film.window();
  std::vector<IdCount> ids;
  size_t i = 0;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x, ++i) {
      float* out = std::copy_n(&picture.data[i * old], old, &all.data[i * stride]);
      for (const Row& row : kRows) {
        if (!holds(film, row)) continue;
        fill(film.ids(row.kind).at(x, y), ids, out);
        out += kPerKind;
      }
    }
  }
  picture = std::move(all);
}

ImageMetadata cryptomatte_metadata(const Film& film, std::span<const std::string> layers) {
  ImageMetadata metadata;
  for (const Row& row : kRows) {
    if (!holds(film, row) || std::find(layers.begin(), layers.end(), row.layer) == layers.end())
      continue;
    // The first seven digits of the name's id tell several Cryptomattes of a file apart.
    const std::string prefix =
        fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", id_of(row.crypto)));
    metadata.emplace_back(prefix + "name", row.crypto);
    metadata.emplace_back(prefix + "hash", "MurmurHash3_32");
    metadata.emplace_back(prefix + "conversion", "uint32_to_float32");
    metadata.emplace_back(prefix + "manifest", manifest(film.ids(row.kind)));
  }
  return metadata;
}

}  // namespace hyades::core
