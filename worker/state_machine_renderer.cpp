// The worker's side of the rendering child: what it is given, what it says, how it ends.
#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "farm/wire.h"
#include "worker/state_machine.h"

namespace hyades::worker {

void StateMachine::renderer_started() { clock_.child_started(); }

void StateMachine::renderer_ready(const pipe::Ready& ready) {
  worker_class_ = ready.worker_class();
  portable_class_ = ready.portable_class();
  build_ = ready.build();
  renderer_up_ = true;
  clock_.heard();
  if (open_ && !welcomed_) send_hello();
  dispatch();
}

void StateMachine::renderer_says(const pipe::FromRenderer& message) {
  clock_.heard();
  switch (message.message_case()) {
    case pipe::FromRenderer::kProgress:
      progressed(message.progress());
      return;
    case pipe::FromRenderer::kStarted:
      started(message.started());
      break;
    case pipe::FromRenderer::kFilm:
      if (!rendered(message.film())) return;
      break;
    case pipe::FromRenderer::kFailed:
      failed(message.failed());
      break;
    case pipe::FromRenderer::kReturned:
      stopped(message.returned().token());
      break;
    case pipe::FromRenderer::kReady:  // heard by renderer_ready()
    case pipe::FromRenderer::kNotReady:
    case pipe::FromRenderer::MESSAGE_NOT_SET:
      break;
  }
  dispatch();
  top_up();
}

/// The unit that the child has; none where it answers late about one that was given up.
StateMachine::Items::iterator StateMachine::in_work(uint64_t token) {
  const auto item = items_.find(token);
  const bool has = item != items_.end() && item->second.state == Item::State::rendering;
  return has ? item : items_.end();
}

void StateMachine::progressed(const pipe::Progress& progress) {
  renderer_memory_ = progress.memory_bytes();
  for (const auto& unit : progress.units()) {
    clock_.progress(unit.token(), unit.samples_done());
    const auto item = items_.find(unit.token());
    if (item != items_.end()) item->second.samples_done = unit.samples_done();
  }
}

void StateMachine::started(const pipe::Started& started) {
  if (const auto item = in_work(started.token()); item != items_.end()) {
    item->second.begun = true;
    item->second.loading = started.loading();
  }
  // Also of a unit that was given up: it holds up the child until it is answered for.
  clock_.begun(started.token(), started.loading());
}

/// Whether the child can be believed.
bool StateMachine::rendered(const pipe::UnitFilm& film) {
  clock_.answered(film.token());
  const auto item = in_work(film.token());
  if (item == items_.end()) return true;
  if (film.batches() > item->second.leased.unit().batches()) {
    distrust("sent a film of more batches than its unit has and was killed");
    return false;
  }
  keep_film(item, film);
  return true;
}

void StateMachine::failed(const pipe::UnitFailed& failed) {
  clock_.answered(failed.token());
  const auto item = in_work(failed.token());
  if (item == items_.end()) return;
  recheck_files(item->second.leased.job(), failed);
  fail(item, failed.reason());
}

/// By hand_over, before its first batch was done.
void StateMachine::stopped(uint64_t token) {
  clock_.answered(token);
  const auto item = in_work(token);
  if (item == items_.end()) return;
  item->second.state = Item::State::waiting;
  item->second.begun = false;
  if (handing_over_) give_back_rest(leaving_reason_);
}

void StateMachine::distrust(const std::string& reason) {
  ports_.kill_renderer(reason);
  lose_renderer(reason, nullptr);
}

void StateMachine::renderer_died(const std::string& reason) { lose_renderer(reason, nullptr); }

/// The child is gone, or as good as that. Units that it had begun are accused, of these only those
/// in `hung` where it is known in which of them it hung.
void StateMachine::lose_renderer(const std::string& reason, const std::set<uint64_t>* hung) {
  renderer_up_ = false;
  clock_.child_gone();
  for (auto& [id, job] : jobs_) job.told = false;
  std::vector<uint64_t> guilty;
  std::vector<uint64_t> accused;
  for (auto& [token, item] : items_) {
    if (item.state != Item::State::rendering) continue;
    if (item.begun && (hung == nullptr || hung->contains(token))) {
      accused.push_back(token);
      if (item.suspect) guilty.push_back(token);
      item.suspect = true;
    }
    item.state = Item::State::waiting;
    item.begun = false;
    item.loading = false;
    item.samples_done = 0;
  }
  // Nothing else was being worked on: no need to try again.
  if (guilty.empty() && accused.size() == 1) guilty = accused;
  for (const uint64_t token : guilty) {
    fail(items_.find(token), "the process that rendered it " + reason);
  }
}

/// Kills a child that hangs. Its units are free at once, whenever it really dies.
void StateMachine::end_hang() {
  const auto hang = clock_.hang();
  if (!hang) return;
  ports_.kill_renderer(hang->reason);
  lose_renderer(hang->reason, &hang->tokens);
}

/// Units that have had their time have failed. The child goes on with the others, unless it does
/// not stop.
void StateMachine::end_overdue() {
  const UnitClock::Overdue overdue = clock_.overdue();
  for (const uint64_t token : overdue.tokens) {
    const auto item = items_.find(token);
    if (item == items_.end() || item->second.state != Item::State::rendering) continue;
    stop_rendering(item);
    fail(item, clock_.overdue_reason());
  }
  if (overdue.stuck) {
    const std::string reason = "did not stop a unit that " + clock_.overdue_reason();
    const std::set<uint64_t> nobody;
    ports_.kill_renderer(reason);
    lose_renderer(reason, &nobody);
  } else if (!overdue.tokens.empty()) {
    dispatch();
  }
}

/// Gives the child what it can work on.
void StateMachine::dispatch() {
  if (!renderer_up_ || handing_over_) return;
  bool suspects = false;
  for (const auto& [token, item] : items_) {
    suspects = suspects || (item.suspect && item.state <= Item::State::rendering);
  }
  for (auto& [token, item] : items_) {
    if (item.state != Item::State::waiting) continue;
    if (suspects) {
      // One suspect at a time, and nothing beside it.
      const bool busy = std::any_of(items_.begin(), items_.end(), [](const auto& entry) {
        return entry.second.state == Item::State::rendering;
      });
      if (busy) return;
      if (!item.suspect) continue;
    }
    tell_child(token, item);
  }
}

void StateMachine::tell_child(uint64_t token, Item& item) {
  Job& job = jobs_.at(item.leased.job());
  if (!job.told) {
    pipe::ToRenderer message;
    message.mutable_job()->set_job(item.leased.job());
    *message.mutable_job()->mutable_spec() = spec_of(job);
    ports_.tell_renderer(std::move(message));
    job.told = true;
  }
  pipe::ToRenderer message;
  message.mutable_unit()->set_token(token);
  message.mutable_unit()->set_job(item.leased.job());
  *message.mutable_unit()->mutable_unit() = item.leased.unit();
  ports_.tell_renderer(std::move(message));
  item.state = Item::State::rendering;
  clock_.given(token, item.leased.job());
}

}  // namespace hyades::worker
