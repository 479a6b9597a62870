// Room on the disk: what is refused and held back while there is little, and what makes more.
#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "core/base/text.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kMeasureEvery = std::chrono::milliseconds(250);
constexpr Duration kMakeRoomEvery = std::chrono::seconds(1);
/// A walk through the folder may take this share of the time: one in so many.
constexpr int kWalkShare = 50;
constexpr std::chrono::milliseconds kAskAgain{5000};

}  // namespace

/// Measures, and does what follows; without the lock. An error of the system changes nothing.
void Controller::mind_disk() {
  auto measured = measure_disk(options_.folder);
  if (!measured) return;
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    // Between two walks what vanishes from the disk is taken for ours.
    measured->used = walked_used_ + surplus(walked_free_, measured->free);
    disk_free_ = measured->free;
    const bool held = disk_.level() != DiskLevel::roomy;
    if (disk_.update(*measured)) {
      for (auto& [id, active] : jobs_) active->touch();
      const bool hold = disk_.level() != DiskLevel::roomy;
      if (hold != held) later = tell(LeasingHeld{hold});
    }
    disk_full_ = disk_.level() == DiskLevel::full;
    const TimePoint now = std::chrono::steady_clock::now();
    if (disk_.level() != DiskLevel::roomy && now - room_made_ >= kMakeRoomEvery) {
      room_made_ = now;
      for (auto& [id, active] : jobs_) {
        if (active->film_store) active->film_store->make_room();
      }
    }
  }
  carry_out(later);
}

/// Where the disk is short, what uploads have left that nobody goes on with makes room: the farm
/// stands still, and who wants his file begins again. Without the lock.
void Controller::sweep_partials() {
  uint64_t shortage = 0;
  {
    const std::lock_guard lock(mutex_);
    shortage = disk_.shortage();
  }
  if (shortage == 0) return;
  const uint64_t freed = assets_->free_partials(shortage);
  if (freed == 0) return;
  const std::lock_guard lock(mutex_);
  // As if the last walk had not found them, so that the next round does not take as many again.
  walked_used_ = surplus(walked_used_, freed);
  walked_free_ += freed;
}

void Controller::disk_loop() {
  TimePoint walk_again;
  TimePoint sweep_again;
  std::unique_lock lock(mutex_);
  while (!stop_) {
    lock.unlock();
    const TimePoint begin = std::chrono::steady_clock::now();
    if (options_.disk.budget > 0 && begin >= walk_again) {
      const auto free = measure_disk(options_.folder);
      const uint64_t used = measure_folder(options_.folder);
      const TimePoint end = std::chrono::steady_clock::now();
      walk_again = end + kWalkShare * (end - begin);
      const std::lock_guard held(mutex_);
      walked_used_ = used;
      walked_free_ = free ? free->free : 0;
    }
    mind_disk();
    if (begin >= sweep_again) {
      sweep_again = begin + kMakeRoomEvery;
      sweep_partials();
    }
    lock.lock();
    disk_wake_.wait_for(lock, kMeasureEvery, [&] { return stop_.load(); });
  }
}

grpc::Status Controller::admit(uint64_t bytes) {
  mind_disk();
  const std::lock_guard lock(mutex_);
  if (disk_.level() != DiskLevel::roomy) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             disk_.reason() + "; nothing new is taken in until there is room",
                             kAskAgain);
  }
  const uint64_t room = surplus(disk_.room(), assets_->expected());
  if (bytes <= room) return grpc::Status::OK;
  return farm::retry_later(
      grpc::StatusCode::RESOURCE_EXHAUSTED,
      fmt::format("a file of {} does not fit: the coordinator's disk has room for {} more",
                  core::format_bytes(bytes), core::format_bytes(room)),
      kAskAgain);
}

/// Whether the disk may be why a frame could not be finished; without the lock.
bool Controller::disk_is_short_for(const core::Film& film) {
  mind_disk();
  const uint64_t memory = film.memory();
  const std::lock_guard lock(mutex_);
  // The film is written for the finisher, and its outputs are hardly larger.
  return disk_.level() != DiskLevel::roomy || disk_free_ < 2 * memory;
}

}  // namespace hyades::coordinator
