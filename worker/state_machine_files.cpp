// The files of jobs: what waits for them, what is damaged of them, when they may go.
#include <algorithm>
#include <cstddef>
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
  if (!ports_.has_files(id)) return;  // they were let go of since; what is fetched now is to come
  job->second.fetching = false;
  job->second.has_files = true;
  job->second.rests.reset();
  job->second.trouble.clear();
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

void StateMachine::files_failed(uint64_t id, const std::string& why, FilesTrouble trouble,
                                TimePoint now) {
  const std::string reason = farm::wire_text(why);
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return;
  job->second.fetching = false;
  if (trouble == FilesTrouble::hopeless) job->second.hopeless = reason;
  std::vector<uint64_t> waiting;
  for (const auto& [token, item] : items_) {
    if (item.leased.job() == id && item.state == Item::State::fetching) waiting.push_back(token);
  }
  v1::WorkerMessage message;
  message.mutable_returned()->set_reason(reason);
  for (const uint64_t token : waiting) {
    const auto item = items_.find(token);
    if (trouble == FilesTrouble::hopeless) {
      fail(item, reason);
    } else {
      *message.mutable_returned()->add_units() = item->second.leased;
      drop(item);
    }
  }
  if (trouble != FilesTrouble::hopeless) {
    // They would only come back at once.
    const bool alone = trouble == FilesTrouble::job;
    (alone ? job->second.rests_until : rests_until_) =
        now + (alone ? job->second.rests : rests_).next();
    std::string& told = alone ? job->second.trouble : files_trouble_;
    if (std::exchange(told, reason) != reason) {
      ports_.note(farm::LogLevel::warning, "units go back: " + reason, {id, {}, {}, {}});
    }
    if (!waiting.empty() && welcomed_) ports_.send(std::move(message));
  }
  top_up();
}

void StateMachine::fetch_files(uint64_t id, Job& job) {
  if (job.has_files || job.fetching || job.rests_until) return;
  job.fetching = true;
  ports_.note(farm::LogLevel::debug, "fetches its files", {id, {}, {}, {}});
  ports_.fetch(id, spec_of(job));
}

/// How many units wait for the end of their job's rest. Given back at once they would come again at
/// once, since nobody has less in work than the job's owner: others would not have their turn.
size_t StateMachine::held() const {
  return static_cast<size_t>(std::count_if(items_.begin(), items_.end(), [&](const auto& entry) {
    const Item& item = entry.second;
    return item.state == Item::State::fetching && jobs_.at(item.leased.job()).rests_until;
  }));
}

void StateMachine::end_rests(TimePoint now) {
  if (rests_until_ && now >= *rests_until_) rests_until_.reset();
  if (asks_again_ && now >= *asks_again_) asks_again_.reset();
  for (auto& [id, job] : jobs_) {
    if (!job.rests_until || now < *job.rests_until) continue;
    job.rests_until.reset();
    const bool wanted = std::any_of(items_.begin(), items_.end(), [id = id](const auto& entry) {
      return entry.second.leased.job() == id && entry.second.state == Item::State::fetching;
    });
    if (wanted) fetch_files(id, job);
  }
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
  job->second.fetching = false;  // nobody answers for it any more
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
