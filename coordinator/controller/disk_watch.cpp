#include "coordinator/controller/disk_watch.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kMakeRoomEvery = std::chrono::seconds(1);
/// A walk through the folder may take this share of the time: one in so many.
constexpr int kWalkShare = 50;
constexpr std::chrono::milliseconds kAskAgain{5000};

}  // namespace

void DiskWatch::measure() {
  auto measured = measure_disk(context_.options.files);
  if (!measured) return;
  Turn turn(dispatcher_);
  // Between two walks what vanishes from the disk is taken for ours.
  measured->used = walked_used_ + surplus(walked_free_, measured->free);
  free_ = measured->free;
  const bool held = room_.level() != DiskLevel::roomy;
  if (room_.update(*measured)) {
    for (const auto& [id, active] : jobs_.all()) active->touch();
    const bool hold = room_.level() != DiskLevel::roomy;
    if (hold != held) turn.tell(LeasingHeld{hold});
  }
  full_ = room_.level() == DiskLevel::full;
  const TimePoint now = std::chrono::steady_clock::now();
  if (room_.level() != DiskLevel::roomy && now - room_made_ >= kMakeRoomEvery) {
    room_made_ = now;
    for (const auto& [id, active] : jobs_.all()) {
      if (active->film_store) active->film_store->make_room();
    }
  }
}

/// Where the disk is short, removes what is left of uploads that nobody goes on with: the farm
/// stands still, and whoever wants such a file can upload it again.
void DiskWatch::sweep_partials() {
  uint64_t shortage = 0;
  {
    const StateLock lock(context_.mutex);
    shortage = room_.shortage();
  }
  if (shortage == 0) return;
  const uint64_t freed = context_.assets->free_partials(shortage);
  if (freed == 0) return;
  const StateLock lock(context_.mutex);
  // As if the last walk had not found them, so that the next round does not take as many again.
  walked_used_ = surplus(walked_used_, freed);
  walked_free_ += freed;
}

void DiskWatch::start() {
  rounds_.add(0, [this] {
    if (!context_.stop) look();
    return context_.stop.load();
  });
}

/// Adds up what the folder takes.
void DiskWatch::walk() {
  const auto free = measure_disk(context_.options.files);
  const uint64_t used = measure_folder(context_.options.files);
  const StateLock lock(context_.mutex);
  walked_used_ = used;
  walked_free_ = free ? free->free : 0;
}

void DiskWatch::look() {
  const TimePoint begin = std::chrono::steady_clock::now();
  if (context_.options.disk.budget > 0 && begin >= walk_again_) {
    walk();
    const TimePoint end = std::chrono::steady_clock::now();
    walk_again_ = end + kWalkShare * (end - begin);
  }
  measure();
  if (begin < sweep_again_) return;
  sweep_again_ = begin + kMakeRoomEvery;
  sweep_partials();
}

grpc::Status DiskWatch::admit(uint64_t bytes, const std::string& owner) {
  measure();
  const auto expected = context_.assets->expected_of_owners();
  const StateLock lock(context_.mutex);
  if (room_.level() != DiskLevel::roomy) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             room_.reason() + "; nothing new is taken in until there is room",
                             kAskAgain);
  }
  const uint64_t room = room_beside(room_.room(), expected, owner);
  if (bytes <= room) return grpc::Status::OK;
  return farm::retry_later(
      grpc::StatusCode::RESOURCE_EXHAUSTED,
      fmt::format("a file of {} does not fit: the coordinator's disk has room for {} more",
                  core::format_bytes(bytes), core::format_bytes(room)),
      kAskAgain);
}

bool DiskWatch::is_short_for(const core::Film& film) {
  // Something has failed, which is rare: what others free on the disk meanwhile must not hide why.
  if (context_.options.disk.budget > 0) walk();
  measure();
  const uint64_t memory = film.memory();
  const StateLock lock(context_.mutex);
  // The film is written for the finisher, and its outputs are hardly larger.
  return room_.level() != DiskLevel::roomy || free_ < 2 * memory;
}

}  // namespace hyades::coordinator
