#include "core/film/film_exr_ids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace hyades::core {
namespace {

constexpr const char* kWords[kIdKinds] = {"object", "material"};
constexpr IdKind kKinds[kIdKinds] = {IdKind::object, IdKind::material};

std::string channel_name(size_t kind, size_t rank, bool count) {
  return fmt::format("{}.{}.{}", kWords[kind], rank, count ? "count" : "id");
}

size_t most_in_a_pixel(const IdLayer& ids) {
  size_t most = 0;
  for (int y = ids.window().y0; y < ids.window().y1; ++y) {
    size_t here = 0;
    const IdCount* before = nullptr;
    for (const IdCount& entry : ids.row(y)) {
      here = before != nullptr && before->pixel == entry.pixel ? here + 1 : 1;
      most = std::max(most, here);
      before = &entry;
    }
  }
  return most;
}

}  // namespace

IdRows::IdRows(const Film& film) : window_(film.window()) {
  for (size_t kind = 0; kind < kIdKinds; ++kind)
    ranks_[kind] = most_in_a_pixel(film.ids(kKinds[kind]));
  make();
}

IdRows::IdRows(const FilmLayout& layout, const PixelRect& window, const Imf::ChannelList& channels)
    : window_(window) {
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    if (!layout.layers.ids[kind]) continue;
    size_t& ranks = ranks_[kind];
    while (channels.findChannel(channel_name(kind, ranks, false)) != nullptr &&
           channels.findChannel(channel_name(kind, ranks, true)) != nullptr) {
      ++ranks;
    }
  }
  make();
}

void IdRows::make() {
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    for (size_t rank = 0; rank < ranks_[kind]; ++rank) {
      names_.push_back(channel_name(kind, rank, false));
      names_.push_back(channel_name(kind, rank, true));
    }
  }
  row_.resize(static_cast<size_t>(window_.width()) * names_.size());
}

size_t IdRows::entry(size_t kind, int x, size_t rank) const {
  const size_t before = kind == 0 ? 0 : ranks_[0];
  return static_cast<size_t>(x) * names_.size() + 2 * (before + rank);
}

void IdRows::insert(Imf::FrameBuffer& buffer) {
  const size_t stride = names_.size() * sizeof(uint32_t);
  for (size_t i = 0; i < names_.size(); ++i) {
    // All rows lie in the same place: they come and go one by one.
    buffer.insert(names_[i], Imf::Slice(Imf::UINT,
                                        reinterpret_cast<char*>(row_.data() + i) -
                                            static_cast<ptrdiff_t>(stride) * window_.x0,
                                        stride, 0));
  }
}

void IdRows::fill(const Film& film, int y) {
  std::fill(row_.begin(), row_.end(), 0U);
  const auto width = static_cast<uint32_t>(window_.width());
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    if (ranks_[kind] == 0) continue;
    size_t rank = 0;
    const IdCount* before = nullptr;
    for (const IdCount& id : film.ids(kKinds[kind]).row(y)) {
      rank = before != nullptr && before->pixel == id.pixel ? rank + 1 : 0;
      before = &id;
      uint32_t* const to = &row_[entry(kind, static_cast<int>(id.pixel % width), rank)];
      to[0] = id.id;
      to[1] = id.count;
    }
  }
}

bool IdRows::take(int y, Film& film) const {
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    std::vector<IdCount> ids;
    const auto first = static_cast<uint32_t>(int64_t{y - window_.y0} * window_.width());
    for (int x = 0; x < window_.width(); ++x) {
      bool ended = false;
      for (size_t rank = 0; rank < ranks_[kind]; ++rank) {
        const uint32_t* const from = &row_[entry(kind, x, rank)];
        ended = ended || from[1] == 0;
        if (ended && (from[0] != 0 || from[1] != 0)) return false;
        if (!ended) ids.push_back({first + static_cast<uint32_t>(x), from[0], from[1]});
      }
    }
    if (ranks_[kind] > 0 && !film.mutable_ids(kKinds[kind]).add_sorted(ids)) return false;
  }
  return true;
}

}  // namespace hyades::core
