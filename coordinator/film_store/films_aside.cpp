#include "coordinator/film_store/films_aside.h"

#include <cstddef>
#include <span>
#include <utility>
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

core::Status FilmsAside::put(int32_t frame, const core::Film& film, int32_t tile_size,
                             const FrameKey& key, const std::string& worker_class) {
  auto file = files_.create(path(frame));
  if (!file) return file.error();
  Put put{0, may_be_too_large(film), {}, {}};
  const auto write = [&](std::span<const std::byte> bytes) -> core::Status {
    const uint64_t size = bytes.size();
    put.bytes += sizeof size + size;
    if (core::Status done = (*file)->write(std::as_bytes(std::span(&size, 1))); !done) return done;
    return (*file)->write(bytes);
  };
  const core::Status written =
      write_film(frame, key, film, {region_, tile_size, 0}, worker_class, write);
  file->reset();
  if (!written) {
    (void)files_.remove(path(frame));
    return written;
  }
  frames_[frame] = put;
  return {};
}

void FilmsAside::leave(const FilmLog& log, int32_t frame, std::vector<RecordPlace> records) {
  log_ = &log;
  frames_[frame] = {0, false, std::move(records), {}};
}

void FilmsAside::move(int32_t frame, std::vector<RecordPlace> records) {
  const auto known = frames_.find(frame);
  if (known == frames_.end()) return;
  known->second.places = std::move(records);
  known->second.added.clear();
}

void FilmsAside::add(int32_t frame, std::vector<std::byte> record) {
  frames_.at(frame).added.push_back(std::move(record));
}

core::Result<std::shared_ptr<core::Film>> FilmsAside::read(int32_t frame) const {
  std::shared_ptr<core::Film> whole;
  core::Status refused;
  const core::Status read = copy(frame, [&](std::span<const std::byte> record) {
    refused = merge_record(record, region_, whole);
    return refused;
  });
  damaged_ = damaged_ || !refused;
  if (!read) return read.error();
  return whole;
}

core::Status FilmsAside::copy(int32_t frame, const FilmLog::Sink& take) const {
  damaged_ = false;
  const auto known = frames_.find(frame);
  if (known == frames_.end()) return core::Error{"the film is not aside"};
  const Put& put = known->second;
  core::Status copied = put.places.empty() ? copy_file(frame, put, take) : copy_log(put, take);
  for (const std::vector<std::byte>& record : put.added) {
    if (copied) copied = take(record);
  }
  return copied;
}

core::Status FilmsAside::copy_log(const Put& put, const FilmLog::Sink& take) const {
  for (const RecordPlace& place : put.places) {
    const auto record = log_->read(place, damaged_);
    if (!record) return record.error();
    if (core::Status taken = take(*record); !taken) return taken;
  }
  return {};
}

core::Status FilmsAside::copy_file(int32_t frame, const Put& put, const FilmLog::Sink& take) const {
  const auto file = files_.open(path(frame));
  if (!file) return file.error();
  // Its records tell when they are damaged, but not that some are gone.
  damaged_ = (*file)->size() != put.bytes;
  if (damaged_) return core::Error{"some of it is gone"}.in(path(frame));
  std::vector<std::byte> record;
  for (uint64_t at = 0; at < (*file)->size();) {
    uint64_t size = 0;
    core::Status read = (*file)->read(at, std::as_writable_bytes(std::span(&size, 1)));
    damaged_ = read && size > (*file)->size() - at - sizeof size;
    if (damaged_) read = core::Error{"it is cut off"};
    if (read) {
      record.resize(size);
      read = (*file)->read(at + sizeof size, record);
    }
    if (!read) return read.error().in(path(frame));
    if (core::Status taken = take(record); !taken) return taken;
    at += sizeof size + size;
  }
  return {};
}

void FilmsAside::remove(int32_t frame) {
  const auto known = frames_.extract(frame);
  if (known && known.mapped().places.empty()) (void)files_.remove(path(frame));
}

void FilmsAside::remove_all() {
  while (!frames_.empty()) remove(frames_.begin()->first);
}

}  // namespace hyades::coordinator
