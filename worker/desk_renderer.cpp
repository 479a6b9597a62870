// The desk's side of the rendering child: what it is given, what it says, how it ends.
#include <algorithm>
#include <utility>

#include "farm/wire.h"
#include "worker/desk.h"

namespace hyades::worker {

void Desk::renderer_started() { watch_.child_started(); }

void Desk::renderer_ready(const pipe::Ready& ready) {
  worker_class_ = ready.worker_class();
  build_ = ready.build();
  renderer_up_ = true;
  watch_.heard();
  if (open_ && !welcomed_) send_hello();
  dispatch();
}

void Desk::renderer_says(pipe::FromRenderer message, TimePoint /*now*/) {
  watch_.heard();
  if (message.has_progress()) {
    renderer_memory_ = message.progress().memory_bytes();
    for (const auto& unit : message.progress().units()) {
      watch_.progress(unit.token(), unit.samples_done());
      const auto item = items_.find(unit.token());
      if (item != items_.end()) item->second.samples_done = unit.samples_done();
    }
    return;
  }
  const auto answered = [&](uint64_t token) {
    watch_.answered(token);
    unit_limit_.answered(token);
  };
  const auto named = [&](uint64_t token) {
    const auto item = items_.find(token);
    // The child may answer late about a unit that was given up.
    const bool in_work = item != items_.end() && item->second.state == Item::State::rendering;
    return in_work ? item : items_.end();
  };
  if (message.has_started()) {
    if (const auto item = named(message.started().token()); item != items_.end()) {
      item->second.begun = true;
      item->second.loading = message.started().loading();
    }
    // Also of a unit that was given up: it holds up the child until it is answered for.
    if (watch_.knows(message.started().token())) {
      unit_limit_.begun(message.started().token(), message.started().loading());
    }
    if (message.started().loading()) {
      watch_.loading(message.started().token());
    } else {
      watch_.rendering(message.started().token());
    }
  } else if (message.has_film()) {
    answered(message.film().token());
    if (const auto item = named(message.film().token()); item != items_.end()) {
      if (message.film().batches() > item->second.leased.unit().batches()) {
        distrust("sent a film of more batches than its unit has and was killed");
        return;
      }
      keep_film(item, message.film());
    }
  } else if (message.has_failed()) {
    answered(message.failed().token());
    if (const auto item = named(message.failed().token()); item != items_.end()) {
      doubt_files(item->second.leased.job(), message.failed());
      fail(item, message.failed().reason());
    }
  } else if (message.has_returned()) {
    answered(message.returned().token());
    // Stopped by hand_over before its first batch was done.
    if (const auto item = named(message.returned().token()); item != items_.end()) {
      item->second.state = Item::State::waiting;
      item->second.begun = false;
      if (handing_over_) give_back_rest(leaving_reason_);
    }
  }
  dispatch();
  top_up();
}

/// Files of other jobs are none of the child's business.
void Desk::doubt_files(uint64_t id, const pipe::UnitFailed& failed) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end() || failed.damaged().empty()) return;
  const std::set<std::string> damaged(failed.damaged().begin(), failed.damaged().end());
  for (const v1::JobFile& file : job->second.spec.files()) {
    const std::string name = farm::hex_from_wire(file.sha256());
    if (!damaged.contains(name)) continue;
    ports_.doubt(name);
    job->second.has_files = false;  // fetched, which looks at it, before the next unit
  }
}

void Desk::distrust(const std::string& reason) {
  ports_.kill_renderer(reason);
  lose_renderer(reason, nullptr);
}

void Desk::renderer_died(const std::string& reason) { lose_renderer(reason, nullptr); }

/// The child is gone, or as good as that. Units that it had begun are accused, of these only those
/// in `hung` where it is known in which of them it hung.
void Desk::lose_renderer(const std::string& reason, const std::set<uint64_t>* hung) {
  renderer_up_ = false;
  watch_.child_gone();
  unit_limit_.child_gone();
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
void Desk::watch(TimePoint now) {
  const auto hang = watch_.tick(now);
  if (!hang) return;
  ports_.kill_renderer(hang->reason);
  lose_renderer(hang->reason, &hang->tokens);
}

/// Units that have had their time have failed. The child goes on with the others, unless it does
/// not stop.
void Desk::end_overdue(TimePoint now) {
  const UnitLimit::Overdue overdue = unit_limit_.tick(now);
  for (const uint64_t token : overdue.tokens) {
    const auto item = items_.find(token);
    if (item == items_.end() || item->second.state != Item::State::rendering) continue;
    stop_rendering(item);
    fail(item, unit_limit_.reason());
  }
  if (overdue.stuck) {
    const std::string reason = "did not stop a unit that " + unit_limit_.reason();
    const std::set<uint64_t> nobody;
    ports_.kill_renderer(reason);
    lose_renderer(reason, &nobody);
  } else if (!overdue.tokens.empty()) {
    dispatch();
  }
}

/// Gives the child what it can work on.
void Desk::dispatch() {
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

void Desk::tell_child(uint64_t token, Item& item) {
  JobState& job = jobs_[item.leased.job()];
  if (!job.told) {
    pipe::ToRenderer message;
    message.mutable_job()->set_job(item.leased.job());
    *message.mutable_job()->mutable_spec() = job.spec;
    ports_.tell_renderer(std::move(message));
    job.told = true;
  }
  pipe::ToRenderer message;
  message.mutable_unit()->set_token(token);
  message.mutable_unit()->set_job(item.leased.job());
  *message.mutable_unit()->mutable_unit() = item.leased.unit();
  ports_.tell_renderer(std::move(message));
  item.state = Item::State::rendering;
  watch_.told(token, item.leased.job());
}

}  // namespace hyades::worker
