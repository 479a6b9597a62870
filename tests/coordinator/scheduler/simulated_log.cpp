// The store of a world with real films: the film log over a disk that fails.
#include <algorithm>

#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

/// The coordinator starts: what the job's log holds is what is known of it. (Failed frames are kept
/// elsewhere.)
void SimulatedWorld::take_up(SimJob& job) {
  const LogContents contents = job.disk->open();
  job.settled = job.heard = job.disk->durable();
  job.stored.finished.clear();
  job.stored.accepted.clear();
  for (const auto& [frame, record] : contents.finished) job.stored.finished.push_back(frame);
  job.stored_units.clear();
  job.stored.disputed = contents.disputed;
  for (const auto& [frame, units] : contents.units) {
    for (const AcceptedUnit& u : units) job.stored_units.insert(name(u.unit));
    job.stored.accepted.insert(job.stored.accepted.end(), units.begin(), units.end());
    films_replayed += units.size();
  }
  // What the log holds no more was void before it was heard of.
  std::erase_if(job.disagreed,
                [&](const core::Unit& u) { return !job.stored_units.contains(name(u)); });
  for (auto& [number, frame] : job.frames) {
    frame.film = job.disk->blank();
    frame.in_memory = false;
    if (job.disk->is_aside(number)) frame.digest = job.disk->digest_aside(number);
    frame.lost = false;
    frame.asked_aside = 0;
    const auto units = contents.units.find(number);
    if (units != contents.units.end()) frame.worker_class = units->second.front().worker_class;
  }
}

void SimulatedWorld::append(SimJob& job, const Persist& a) {
  const auto* unit = std::get_if<UnitRecord>(&a.record);
  const auto sequence = job.disk->append(a.record, unit ? unit->accepted.digest[1] : 0);
  if (!sequence) {
    ++refused;
    return tell_later(PersistFailed{a.id, sequence.error().message});
  }
  job.appended.emplace_back(*sequence, a);
  commit_soon(job, std::chrono::milliseconds(number(1, 5)));
}

void SimulatedWorld::commit_soon(SimJob& job, Duration delay) {
  if (std::exchange(job.committing, true)) return;
  after(delay, [this, &job, g = generation_] {
    if (g != generation_) return;  // it died before
    job.committing = false;
    commit(job);
  });
}

void SimulatedWorld::commit(SimJob& job) {
  FaultyFiles& files = job.disk->files();
  bool power_goes = false;
  if (fault()) {
    switch (number(0, 3)) {
      case 0:
        files.fail_next_sync();
        break;
      case 1:
        files.fail_next_write_after(static_cast<size_t>(number(0, 2000)));
        break;
      case 2:
        files.fail_next_write_after(static_cast<size_t>(number(0, 2000)));
        files.fail_next_truncate();
        break;
      default:
        // In the middle: before the write, before the sync, or after both.
        power_goes = chance(0.3);
        if (power_goes) {
          files.fail_from_operation(files.operations() + static_cast<uint64_t>(number(0, 3)));
        }
    }
  }
  const core::Status stored = job.disk->commit();
  if (power_goes) return crash_coordinator(true);
  if (!stored) {
    ++failed_commits;
    return commit_soon(job, std::chrono::milliseconds(250));
  }
  after(delay(), [this, &job, through = job.disk->durable(), g = generation_] {
    if (g == generation_) settle(job, through);
  });
}

/// The scheduler hears what is durable, in order.
void SimulatedWorld::settle(SimJob& job, uint64_t durable) {
  job.heard = std::max(job.heard, durable);
  run_calls(job);
  if (job.telling) return;  // it comes to this afterwards
  while (!job.appended.empty() && job.appended.front().first <= job.heard) {
    const auto [sequence, persist] = job.appended.front();
    job.appended.pop_front();
    job.settled = sequence;
    store(persist.record);
    tell_of_lost_films();
    tell(Persisted{persist.id});
  }
  // Once it is compacted, the log does not know any more whose film is whose.
  if (!corrupt_ && !job.ended && chance(0.03)) compact(job);
}

void SimulatedWorld::compact(SimJob& job) {
  std::map<int32_t, SimulatedDisk::Frame> frames;
  for (const auto& [number, frame] : job.frames) {
    if (!frame.over) frames[number] = {&frame.film, frame.worker_class};
  }
  FaultyFiles& files = job.disk->files();
  const bool power_goes = fault();
  if (power_goes) {
    files.fail_from_operation(files.operations() + static_cast<uint64_t>(number(0, 12)));
  }
  const bool done = job.disk->compact(job.settled, job.stored.finished, frames).ok();
  compactions += done;
  aside.compactions += done && job.disk->any_aside();
  if (power_goes) crash_coordinator(true);
}

/// For a while there is next to no room.
void SimulatedWorld::disks_fill() {
  for (auto& [id, job] : jobs_) {
    job.disk->files().set_capacity(job.disk->used() + static_cast<uint64_t>(number(0, 5000)));
  }
  const bool noticed = chance(0.3);
  if (noticed) tell(LeasingHeld{true});
  after(std::chrono::milliseconds(number(500, 15'000)), [this] {
    for (auto& [id, job] : jobs_) job.disk->files().set_capacity(UINT64_MAX);
    tell(LeasingHeld{false});
  });
}

/// All jobs have ended. The power goes once more: the log must still hold every finished frame.
void SimulatedWorld::check_disks() {
  std::mt19937 chances(static_cast<uint32_t>(random_()));
  for (auto& [id, job] : jobs_) {
    if (!job.disk || job.cancelled) continue;
    job.disk->files().set_capacity(UINT64_MAX);
    job.disk->die(true, chances);
    const LogContents contents = job.disk->open();
    for (const int32_t frame : job.stored.finished) {
      if (!contents.finished.contains(frame)) fail("a finished frame is forgotten");
    }
  }
}

}  // namespace hyades::coordinator
