#include "coordinator/controller/diagnosis.h"

#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/counted.h"
#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/lease_renewal.h"
#include "coordinator/controller/not_there.h"
#include "coordinator/controller/video_maker.h"
#include "coordinator/controller/worker_sessions.h"
#include "core/base/text.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// Of each kind of reason: so many are told, and the others counted. A job may have a million
/// frames.
constexpr size_t kMostTold = 20;

class Reasons {
 public:
  explicit Reasons(v1::ExplainResponse& response) : response_(response) {}

  void say(const std::string& text) { response_.add_reasons(farm::wire_text(text)); }
  /// One of many `kind`s ("frames have failed"), which end_kind() sums up.
  template <class... Parts>
  void say_one(fmt::format_string<Parts...> format, Parts&&... parts) {
    if (++told_ > kMostTold + 1) return;
    last_ = fmt::format(format, std::forward<Parts>(parts)...);
    if (told_ <= kMostTold) say(last_);
  }
  void end_kind(const char* kind) {
    if (told_ == kMostTold + 1) say(last_);
    if (told_ > kMostTold + 1) say(fmt::format("{} more {}", told_ - kMostTold, kind));
    told_ = 0;
  }

 private:
  v1::ExplainResponse& response_;
  size_t told_ = 0;
  std::string last_;
};

}  // namespace

grpc::Status Diagnosis::explain(uint64_t id, v1::ExplainResponse& response) {
  if (explain_open(id, response)) return grpc::Status::OK;
  const auto stored = shared_.store->job(id);
  if (!stored) {
    return farm::retry_later(grpc::StatusCode::UNAVAILABLE, stored.error().message,
                             std::chrono::seconds(1));
  }
  if (!*stored) return no_job(id);
  Reasons reasons(response);
  switch ((*stored)->state) {
    case StoredState::running:
    case StoredState::paused:
      reasons.say((*stored)->reason.empty() ? std::string("it is being taken up")
                                            : "it " + (*stored)->reason);
      break;
    case StoredState::done:
      reasons.say("it is done");
      break;
    case StoredState::cancelled:
      reasons.say("it was cancelled; 'retry' takes it up again");
      break;
    default:
      reasons.say("it is over, but not all of it is done: " + (*stored)->reason +
                  "; 'retry' takes it up again");
  }
  const auto doubtful = shared_.store->doubtful(id, UINT32_MAX);
  if (!doubtful) return farm::unavailable(doubtful.error());
  for (const int32_t frame : *doubtful) {
    reasons.say_one(
        "frame {} is in doubt: a worker that had a part in it was found odd after it was finished; "
        "'retry' renders it again",
        frame);
  }
  reasons.end_kind("frames are in doubt");
  return grpc::Status::OK;
}

bool Diagnosis::explain_open(uint64_t id, v1::ExplainResponse& response) {
  const StateLock lock(shared_.mutex);
  ActiveJob* active = jobs_.find(id);
  if (active == nullptr) return false;
  Reasons reasons(response);
  const auto say = [&](const std::string& text) { reasons.say(text); };
  if (disk_.level() != DiskLevel::roomy) {
    say(disk_.reason() +
        (disk_.level() == DiskLevel::full ? "; no units are leased and films have to wait"
                                          : "; no units are leased") +
        " until there is room again (deleting jobs that have ended makes some)");
  }
  if (!active->trouble.empty()) say(active->trouble);
  if (!active->row_trouble.empty()) say(active->row_trouble);
  if (active->stored.state == StoredState::paused) say("it is paused; 'resume' lets it go on");
  if (active->making_videos) {
    say(videos_.is_making(active->id)
            ? "all frames are done, and its videos are being made of them"
            : "all frames are done; its videos wait for those of another job");
    return true;
  }
  uint32_t available = 0;
  std::map<std::string, uint32_t> classes;
  for (const auto& [worker, session] : workers_.all()) {
    if (!session.joined || session.state != v1::WORKER_STATE_ACTIVE) continue;
    ++available;
    ++classes[session.hello.worker_class()];
  }
  const std::string unmet = unmet_needs(active->stored);
  if (available == 0) say("no worker is there that could take units");
  if (!unmet.empty()) say(unmet);
  if (available == 0 || !unmet.empty()) {
    for (const std::string& barred : barred_workers()) say(barred);
  }
  uint32_t waiting = 0;
  for (const auto& [number, note] : active->frames) {
    if (note.state == v1::FRAME_STATE_WAITING) ++waiting;
    if (note.state != v1::FRAME_STATE_FINISHING) continue;
    reasons.say_one("frame {} is rendered; its outputs are being made", number);
  }
  reasons.end_kind("frames are rendered; their outputs are being made");
  for (const auto& [number, note] : active->frames) {
    if (note.state != v1::FRAME_STATE_FAILED) continue;
    reasons.say_one("frame {} failed: {}", number, note.reason);
  }
  reasons.end_kind("frames failed");
  bool orphans = false;
  for (const auto& [number, note] : active->frames) {
    if (note.state != v1::FRAME_STATE_RENDERING || available == 0 || note.worker_class.empty() ||
        classes.contains(note.worker_class)) {
      continue;
    }
    orphans = true;
    reasons.say_one(
        "frame {} was begun by workers of class {}, and none of them is there; it "
        "begins again with another class {} s after the last one went",
        number, note.worker_class.substr(0, 12),
        std::chrono::duration_cast<std::chrono::seconds>(shared_.options.class_patience).count());
  }
  reasons.end_kind("frames were begun by workers of classes of which none is there");
  if (const uint32_t disputed = dispatcher_.scheduler().disputed_units(active->id); disputed > 0) {
    say(fmt::format(
        "{} rendered differently by two workers of one class and {} for another worker of it to "
        "say who is right",
        counted(disputed, "unit") + (disputed == 1 ? " was" : " were"),
        disputed == 1 ? "waits" : "wait"));
  }
  if (available > 0 && dispatcher_.scheduler().waits_for_film(active->id)) {
    say(fmt::format(
        "a frame waits for memory for its film of {}: those of frames in work, of all "
        "jobs, take {} of {} (--film-memory)",
        core::format_bytes(active->film_bytes), core::format_bytes(dispatcher_.scheduler().films()),
        core::format_bytes(shared_.options.film_memory)));
  }
  for (const std::string& still : still_units(active->id)) say(still);
  const uint32_t leased = dispatcher_.scheduler().leased_units(active->id);
  if (leased > 0) {
    for (const std::string& where : where_units_are(active->id)) say(where);
    if (active->stored.max_workers > 0) {
      say(fmt::format("at most {} may render it at once",
                      counted(active->stored.max_workers, "worker")));
    }
  } else if (available > 0 && !orphans && unmet.empty() &&
             active->stored.state == StoredState::running) {
    for (const auto& [other, rival] : jobs_.all()) {
      if (other != active->id && rival->stored.priority >= active->stored.priority &&
          dispatcher_.scheduler().leased_units(other) > 0) {
        reasons.say_one("job {} ({}, priority {}) has the workers now", rival->stored.id,
                        rival->stored.name, rival->stored.priority);
      }
    }
    reasons.end_kind("jobs have workers now");
    if (sessions_.is_adopting()) {
      say("the coordinator has just started and waits for its workers to come back");
    }
  }
  if (waiting > 0) {
    say(counted(waiting, "frame") +
        (waiting == 1 ? " waits for its turn" : " wait for their turn"));
  }
  if (response.reasons().empty()) say("nothing stands in its way");
  return true;
}

}  // namespace hyades::coordinator
