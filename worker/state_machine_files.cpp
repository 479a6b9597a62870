// The files of jobs: what waits for them, what is damaged of them, when they may go.
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "farm/wire.h"
#include "worker/state_machine.h"

namespace hyades::worker {

void StateMachine::files_are_there(uint64_t id) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) {
    ports_.release(id);  // the job ended meanwhile
    return;
  }
  job->second.fetching = false;
  job->second.has_files = true;
  rests_.reset();
  rests_until_.reset();
  files_trouble_.clear();
  for (auto& [token, item] : items_) {
    if (item.leased.job() == id && item.state == Item::State::fetching) {
      item.state = Item::State::waiting;
    }
  }
  forget_idle_job(id);  // where all its units were taken back meanwhile
  dispatch();
}

void StateMachine::files_failed(uint64_t id, const std::string& why, bool final, TimePoint now) {
  const std::string reason = farm::wire_text(why);
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return;
  job->second.fetching = false;
  std::vector<uint64_t> waiting;
  for (const auto& [token, item] : items_) {
    if (item.leased.job() == id && item.state == Item::State::fetching) waiting.push_back(token);
  }
  v1::WorkerMessage message;
  message.mutable_returned()->set_reason(reason);
  for (const uint64_t token : waiting) {
    const auto item = items_.find(token);
    if (final) {
      fail(item, reason);
    } else {
      *message.mutable_returned()->add_units() = item->second.leased;
      drop(item);
    }
  }
  if (!final) {
    // They would only come back at once.
    rests_until_ = now + rests_.next();
    if (files_trouble_ != reason) {
      ports_.note(farm::LogLevel::warning, "units go back: " + reason, {id, {}, {}, {}});
    }
    files_trouble_ = reason;
    if (!waiting.empty() && welcomed_) ports_.send(std::move(message));
  }
  top_up();
}

/// Files of other jobs are none of the child's business.
void StateMachine::recheck_files(uint64_t id, const pipe::UnitFailed& failed) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end() || failed.damaged().empty()) return;
  const std::set<std::string> damaged(failed.damaged().begin(), failed.damaged().end());
  const v1::JobSpec spec = spec_of(job->second);
  for (const v1::JobFile& file : spec.files()) {
    const std::string name = farm::hex_from_wire(file.sha256());
    if (!damaged.contains(name)) continue;
    ports_.recheck(name);
    job->second.has_files = false;  // fetched, which looks at it, before the next unit
  }
}

v1::JobSpec StateMachine::spec_of(const Job& job) {
  v1::JobSpec spec;
  spec.ParseFromString(job.spec);
  return spec;
}

/// Lets go of a job of which nothing is left to be rendered.
void StateMachine::forget_idle_job(uint64_t id) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return;
  for (const auto& [token, item] : items_) {
    if (item.leased.job() == id && item.state != Item::State::kept) return;
  }
  ports_.release(id);
  job->second.has_files = false;
  if (!job->second.over) return;
  if (job->second.told) {
    pipe::ToRenderer message;
    message.mutable_forget()->set_job(id);
    ports_.tell_renderer(std::move(message));
  }
  brief_bytes_ -= bytes_of(job->second);
  jobs_.erase(job);
}

}  // namespace hyades::worker
