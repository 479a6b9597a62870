#include "coordinator/controller/worker_table.h"

#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/log.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostFramesNamed = 5;

/// "3 units of frame 7 go", "9 units of frames 7, 8 go", "400 units of 80 frames go".
std::string in_words(const std::map<int32_t, uint32_t>& units_of) {
  uint32_t units = 0;
  std::vector<int32_t> frames;
  for (const auto& [frame, count] : units_of) {
    units += count;
    frames.push_back(frame);
  }
  const std::string of =
      frames.size() > kMostFramesNamed
          ? core::counted(frames.size(), "frame")
          : fmt::format("{} {}", frames.size() == 1 ? "frame" : "frames", fmt::join(frames, ", "));
  return fmt::format("{} of {} {}", core::counted(units, "unit"), of, units == 1 ? "goes" : "go");
}

}  // namespace

core::Status WorkerTable::load() {
  const auto stored = context_.store->quarantines();
  if (!stored) return stored.error();
  const StateLock lock(context_.mutex);
  for (const StoredQuarantine& kept : *stored) quarantines_[kept.worker] = kept.reason;
  return {};
}

WorkerSession* WorkerTable::find(WorkerId worker) {
  const auto found = sessions_.find(worker);
  return found == sessions_.end() ? nullptr : &found->second;
}

const WorkerSession* WorkerTable::find(WorkerId worker) const {
  const auto found = sessions_.find(worker);
  return found == sessions_.end() ? nullptr : &found->second;
}

WorkerSession* WorkerTable::find(WorkerId worker, const WorkerLink* link) {
  WorkerSession* session = find(worker);
  return session == nullptr || session->link.get() != link ? nullptr : session;
}

WorkerSession* WorkerTable::find(const std::string& text, grpc::Status& status) {
  WorkerSession* found = nullptr;
  for (auto& [id, session] : sessions_) {
    if (std::to_string(static_cast<uint64_t>(id)) == text) return &session;
    if (session.hello.name() != text) continue;
    if (found != nullptr) {
      status = {grpc::StatusCode::FAILED_PRECONDITION,
                "several workers are called '" + text + "': give the id"};
      return nullptr;
    }
    found = &session;
  }
  if (found == nullptr) {
    status = {grpc::StatusCode::NOT_FOUND, "there is no worker '" + text + "'"};
  }
  return found;
}

WorkerSession& WorkerTable::open(const std::string& worker_id) {
  const auto [known, fresh] = ids_.try_emplace(worker_id, WorkerId{next_worker_});
  if (fresh) ++next_worker_;
  WorkerSession& session = sessions_[known->second];
  session.id = known->second;
  return session;
}

const WorkerSession* WorkerTable::session_of(const std::string& worker_id) const {
  const auto known = ids_.find(worker_id);
  return known == ids_.end() ? nullptr : find(known->second);
}

void WorkerTable::set_joined_with(WorkerSession& session, const std::string& token) {
  const auto before = joined_by_.find(session.joined_with);
  if (before != joined_by_.end() && --before->second == 0) joined_by_.erase(before);
  session.joined_with = token;
  if (!token.empty()) ++joined_by_[token];
}

size_t WorkerTable::joined_by(const std::string& token) const {
  const auto known = joined_by_.find(token);
  return known == joined_by_.end() ? 0 : known->second;
}

void WorkerTable::forget(WorkerId worker, Turn& turn) {
  const auto session = sessions_.find(worker);
  set_joined_with(session->second, {});
  ids_.erase(session->second.hello.worker_id());
  sessions_.erase(session);
  turn.tell(WorkerForgotten{worker});
}

std::vector<std::string> WorkerTable::stable_ids_of(const std::vector<WorkerId>& workers) const {
  std::vector<std::string> names;
  for (const WorkerId worker : workers) {
    const WorkerSession* session = find(worker);
    names.push_back(session == nullptr ? std::string() : session->hello.worker_id());
  }
  return names;
}

void WorkerTable::note_speeds(TimePoint now, const Scheduler& scheduler) {
  for (auto& [id, session] : sessions_) {
    if (!session.joined) continue;
    session.speed.note(session.samples_done, now, scheduler.leased_units(id) > 0);
  }
}

void WorkerTable::send(WorkerId worker, const v1::CoordinatorMessage& message) {
  const WorkerSession* session = find(worker);
  if (session != nullptr && session->link) session->link->send(bytes_of(message));
}

void WorkerTable::send_drain(WorkerSession& session, Turn& turn) {
  v1::CoordinatorMessage message;
  message.mutable_drain()->set_reason(*session.drained);
  send(session.id, message);
  if (session.state == v1::WORKER_STATE_ACTIVE) session.state = v1::WORKER_STATE_DRAINING;
  turn.tell(WorkerBarred{session.id, true});
}

const std::string* WorkerTable::quarantine_of(const std::string& worker_id) const {
  const auto kept = quarantines_.find(worker_id);
  return kept == quarantines_.end() ? nullptr : &kept->second;
}

void WorkerTable::set_quarantine(WorkerSession& session, const std::string& reason) {
  session.state = v1::WORKER_STATE_QUARANTINED;
  session.reason = reason;
  const std::string worker = session.hello.worker_id();
  quarantines_[worker] = reason;
  store_quarantine([this, worker, reason] { return context_.store->quarantine({worker, reason}); });
  const std::string text = reason.empty() ? "is in quarantine" : "is in quarantine: " + reason;
  farm::log_later(farm::LogLevel::warning, text, {{}, {}, {}, session.hello.name()});
  // In the logs of the jobs that it has worked for since it came.
  for (const JobId job : session.spec_sent) {
    if (ActiveJob* active = jobs_.find(job)) {
      jobs_.note(*active, v1::LOG_LEVEL_WARNING, std::nullopt, session.hello.name(), text);
    }
  }
}

void WorkerTable::end_quarantine(WorkerSession& session, const std::string& reason, Turn& turn) {
  const bool leaves = session.leaving || session.drained;
  session.state = !session.joined ? v1::WORKER_STATE_GONE
                  : leaves        ? v1::WORKER_STATE_DRAINING
                                  : v1::WORKER_STATE_ACTIVE;
  session.reason = session.drained.value_or(reason);
  turn.tell(WorkerBarred{session.id, leaves, true});
  const std::string worker = session.hello.worker_id();
  quarantines_.erase(worker);
  store_quarantine([this, worker] { return context_.store->end_quarantine(worker); });
}

void WorkerTable::store_quarantine(std::function<core::Status()> what) {
  context_.background.add(ControllerContext::kWorkersKey,
                          [what = std::move(what)] { return what().ok(); });
}

void WorkerTable::note_losses(const WorkerSession& session, const std::vector<UnitInHand>& units,
                              const std::string& why) {
  std::map<JobId, std::map<int32_t, uint32_t>> lost;
  for (const UnitInHand& held : units) ++lost[held.job][held.unit.frame];
  for (const auto& [job, frames] : lost) {
    ActiveJob* active = jobs_.find(job);
    if (active == nullptr) continue;
    std::optional<int32_t> frame;
    if (frames.size() == 1) frame = frames.begin()->first;
    jobs_.note(*active, v1::LOG_LEVEL_WARNING, frame, session.hello.name(),
               why + ": " + in_words(frames) + " to others");
  }
}

}  // namespace hyades::coordinator
