#include "core/film/id_codec.h"

#include <span>
#include <string>

namespace hyades::core {
namespace {

/// Memory that a pair of pixel and id takes while it is read, at most; see id_memory.
constexpr uint64_t kEntryMemory = 48;
/// Memory that a name takes while it is read, besides its length.
constexpr uint64_t kNameMemory = 128;

}  // namespace

void append_ids(std::vector<std::byte>& out, const IdLayer& layer) {
  append_number(out, static_cast<uint32_t>(layer.names().size()));
  for (const auto& [id, name] : layer.names()) {
    append_number(out, id);
    append_number(out, static_cast<uint16_t>(name.size()));
    for (const char c : name) append_number(out, c);
  }
  std::vector<uint32_t> numbers[3];  // pixels from the entry before, ids, counts
  uint32_t before = 0;
  for (int y = layer.window().y0; y < layer.window().y1; ++y) {
    for (const IdCount& entry : layer.row(y)) {
      numbers[0].push_back(entry.pixel - before);
      numbers[1].push_back(entry.id);
      numbers[2].push_back(entry.count);
      before = entry.pixel;
    }
  }
  append_number(out, static_cast<uint32_t>(numbers[0].size()));
  for (const auto& values : numbers) {
    append_planes(out, std::as_bytes(std::span(values)), sizeof(uint32_t));
  }
}

Status read_ids(ByteReader& in, IdLayer& layer, uint64_t& left) {
  const Error damaged{"its ids are damaged"};
  const auto take = [&](uint64_t bytes) {
    const bool fits = bytes <= left;
    if (fits) left -= bytes;
    return fits;
  };
  const auto names = in.number<uint32_t>();
  for (uint32_t i = 0; i < names; ++i) {
    const auto id = in.number<uint32_t>();
    const auto size = in.number<uint16_t>();
    const std::span<const std::byte> text = in.take(size);
    if (in.failed() || id == IdLayer::kNothing || layer.names().contains(id) ||
        !take(kNameMemory + size)) {
      return damaged;
    }
    layer.name(id, {reinterpret_cast<const char*>(text.data()), text.size()});
  }
  const auto count = in.number<uint32_t>();
  if (in.failed() || !take(kEntryMemory * count)) return damaged;
  std::vector<uint32_t> numbers[3];
  for (auto& values : numbers) {
    values.resize(count);
    if (!read_planes(in, std::as_writable_bytes(std::span(values)), sizeof(uint32_t)))
      return damaged;
  }
  std::vector<IdCount> entries(count);
  uint64_t pixel = 0;
  for (size_t i = 0; i < count; ++i) {
    pixel += numbers[0][i];
    if (pixel > UINT32_MAX) return damaged;
    entries[i] = {static_cast<uint32_t>(pixel), numbers[1][i], numbers[2][i]};
  }
  if (!layer.add_sorted(entries)) return damaged;
  return {};
}

}  // namespace hyades::core
