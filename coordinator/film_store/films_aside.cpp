#include "coordinator/film_store/films_aside.h"

#include <cstddef>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "coordinator/film_store/log_names.h"

namespace hyades::coordinator {

std::string FilmsAside::path(int32_t frame) const {
  return fmt::format("{}/{}{}", folder_, frame, kAsideSuffix);
}

core::Status FilmsAside::remove_left() {
  const auto names = files_.list(folder_);
  if (!names) return names.error();
  for (const std::string& name : *names) {
    if (!name.ends_with(kAsideSuffix)) continue;
    if (core::Status gone = files_.remove(folder_ + "/" + name); !gone) return gone;
  }
  return {};
}

core::Status FilmsAside::put(int32_t frame, const core::Film& film, int32_t tile_size) {
  auto file = files_.create(path(frame));
  if (!file) return file.error();
  Put put{0, may_be_too_large(film)};
  const auto write = [&](std::span<const std::byte> bytes) -> core::Status {
    const uint64_t size = bytes.size();
    put.bytes += sizeof size + size;
    if (core::Status done = (*file)->write(std::as_bytes(std::span(&size, 1))); !done) return done;
    return (*file)->write(bytes);
  };
  // Nobody asks for its key: it is not for another run.
  const core::Status written = write_film(frame, {}, film, {region_, tile_size, 0}, {}, write);
  file->reset();
  if (!written) {
    (void)files_.remove(path(frame));
    return written;
  }
  frames_[frame] = put;
  return {};
}

core::Result<std::shared_ptr<core::Film>> FilmsAside::read(int32_t frame) const {
  const auto known = frames_.find(frame);
  if (known == frames_.end()) return core::Error{"the film is not aside"};
  const auto file = files_.open(path(frame));
  if (!file) return file.error();
  // Its records tell when they are damaged, but not that some are gone.
  if ((*file)->size() != known->second.bytes) {
    return core::Error{"some of it is gone"}.in(path(frame));
  }
  std::shared_ptr<core::Film> whole;
  for (uint64_t at = 0; at < (*file)->size();) {
    uint64_t size = 0;
    core::Status read = (*file)->read(at, std::as_writable_bytes(std::span(&size, 1)));
    if (read && size > (*file)->size() - at) read = core::Error{"it is cut off"};
    if (!read) return read.error().in(path(frame));
    std::vector<std::byte> record(size);
    read = (*file)->read(at + sizeof size, record);
    if (!read) return read.error().in(path(frame));
    const auto part = decode_unit(record);
    if (!part) return part.error().in(path(frame));
    if (!whole) {
      whole = std::make_shared<core::Film>(part->layout(), region_, part->splats().region());
    }
    if (core::Status merged = whole->merge(*part); !merged) return merged.error();
    at += sizeof size + size;
  }
  return whole;
}

void FilmsAside::remove(int32_t frame) {
  if (frames_.erase(frame) > 0) (void)files_.remove(path(frame));
}

void FilmsAside::remove_all() {
  while (!frames_.empty()) remove(frames_.begin()->first);
}

}  // namespace hyades::coordinator
