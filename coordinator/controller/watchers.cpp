#include "coordinator/controller/watchers.h"

#include <utility>

namespace hyades::coordinator {

uint64_t Watchers::watch(uint64_t job, std::function<void()> poke) {
  const StateLock lock(context_.mutex);
  watches_.emplace(next_watch_, Watch{job, 0, std::move(poke)});
  return next_watch_++;
}

void Watchers::unwatch(uint64_t number) {
  const StateLock lock(context_.mutex);
  watches_.erase(number);
}

void Watchers::poke_changed() {
  for (auto& [number, watch] : watches_) {
    const ActiveJob* active = jobs_.find(watch.job);
    if (active == nullptr || active->version == watch.version) continue;
    watch.version = active->version;
    (void)pokes_.submit(watch.poke);  // takes any number
  }
}

void Watchers::poke(uint64_t job) {
  for (const auto& [number, watch] : watches_) {
    if (watch.job == job) (void)pokes_.submit(watch.poke);
  }
}

}  // namespace hyades::coordinator
