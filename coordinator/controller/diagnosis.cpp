#include "coordinator/controller/diagnosis.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/not_found.h"
#include "coordinator/controller/video_maker.h"
#include "coordinator/controller/worker_sessions.h"
#include "core/base/text.h"
#include "core/film/black.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// So many reasons of each kind are listed, and the others counted: a job may have a million
/// frames.
constexpr size_t kMostOfAKind = 20;

constexpr const char* kNobody = "no worker is there that could take units";
/// Different needs of jobs that are held against all workers at a time.
constexpr size_t kMostNeeds = 64;

}  // namespace

class Diagnosis::Reasons {
 public:
  explicit Reasons(v1::ExplainResponse& response) : response_(response) {}

  void say(const std::string& text) { response_.add_reasons(farm::wire_text(text)); }
  /// One of many `kind`s ("frames have failed"), which end_kind() sums up.
  template <class... Parts>
  void say_one(fmt::format_string<Parts...> format, Parts&&... parts) {
    if (++told_ > kMostOfAKind + 1) return;
    last_ = fmt::format(format, std::forward<Parts>(parts)...);
    if (told_ <= kMostOfAKind) say(last_);
  }
  /// Whether more of them would only be counted, which add() does at once.
  bool is_full() const { return told_ > kMostOfAKind; }
  void add(size_t more) { told_ += more; }
  void end_kind(const char* kind) {
    if (told_ == kMostOfAKind + 1) say(last_);
    if (told_ > kMostOfAKind + 1) say(fmt::format("{} more {}", told_ - kMostOfAKind, kind));
    told_ = 0;
  }

 private:
  v1::ExplainResponse& response_;
  size_t told_ = 0;
  std::string last_;
};

grpc::Status Diagnosis::explain(uint64_t id, v1::ExplainResponse& response) {
  if (explain_open(id, response)) return grpc::Status::OK;
  const auto stored = context_.store->summary(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  Reasons reasons(response);
  switch ((*stored)->state) {
    case StoredState::running:
    case StoredState::paused:
      reasons.say((*stored)->reason.empty() ? std::string("it is being recovered")
                                            : "it " + (*stored)->reason);
      break;
    case StoredState::done:
      reasons.say("it is done");
      break;
    case StoredState::cancelled:
      reasons.say("it was cancelled; 'retry' renders what is left of it");
      break;
    default:
      reasons.say("it is over, but not all of it is done: " + (*stored)->reason +
                  "; 'retry' renders it again");
  }
  const auto suspect = context_.store->suspect_frames(id, UINT32_MAX);
  if (!suspect) return farm::unavailable(suspect.error());
  for (const int32_t frame : *suspect) {
    reasons.say_one(
        "frame {} is in doubt: a worker that had a part in it was found divergent after it was "
        "finished; "
        "'retry' renders it again",
        frame);
  }
  reasons.end_kind("frames are in doubt");
  const auto black = context_.store->black(id, UINT32_MAX);
  if (!black) return farm::unavailable(black.error());
  explain_black(*black, reasons);
  return grpc::Status::OK;
}

bool Diagnosis::explain_open(uint64_t id, v1::ExplainResponse& response) {
  const StateLock lock(context_.mutex);
  const ActiveJob* active = jobs_.find(id);
  if (active == nullptr) return false;
  Reasons reasons(response);
  explain_state(*active, reasons);
  explain_black(active->black, reasons);
  if (active->making_videos) {
    reasons.say(videos_.is_making(active->id)
                    ? "all frames are done, and its videos are being made of them"
                    : "all frames are done; its videos wait for those of another job");
    return true;
  }
  std::set<std::string> classes;  // of the workers that could take units
  for (const auto& [worker, session] : workers_.all()) {
    if (session.may_take_units()) classes.insert(session.class_for(active->needs));
  }
  const bool may_begin = explain_workers(*active, !classes.empty(), reasons);
  const bool orphans = explain_frames(*active, classes, reasons);
  const bool out = explain_units(*active, !classes.empty(), reasons);
  if (!out && may_begin && !orphans && active->stored.state == StoredState::running) {
    explain_rivals(*active, reasons);
  }
  if (const uint32_t finishing = active->frames_finishing(); finishing > 0) {
    reasons.say(core::counted(finishing, "frame") +
                (finishing == 1
                     ? " is rendered, and its outputs are being made (denoising takes longest)"
                     : " are rendered: their outputs are made by the coordinator, one frame after "
                       "the other (denoising takes longest)"));
  }
  size_t in_work = 0;
  for (const int32_t number : active->in_work) {
    if (active->frames.at(number).state != v1::FRAME_STATE_WAITING) ++in_work;
  }
  const size_t begun = in_work + active->failed.size() + active->stored.frames_done;
  const size_t waiting = active->frames.size() - std::min(begun, active->frames.size());
  if (waiting > 0) {
    reasons.say(core::counted(waiting, "frame") +
                (waiting == 1 ? " waits for its turn" : " wait for their turn"));
  }
  if (response.reasons().empty()) reasons.say("nothing stands in its way");
  explain_noise(*active, reasons);
  return true;
}

void Diagnosis::note_obstacles() {
  const bool somebody = anybody();
  std::map<std::string, std::string> unmet;  // by needs
  for (const auto& [id, active] : jobs_.all()) {
    std::string obstacle;
    if (!active->is_waiting(dispatcher_.scheduler().leased_units(id))) {
      // What is in the way of the next unit is nobody's question.
    } else if (!somebody) {
      obstacle = kNobody;
    } else if (const JobNeeds& needs = active->needs; needs.any()) {
      const std::string key = fmt::format("{} {} {}", static_cast<int>(needs.render_class),
                                          needs.memory, fmt::join(needs.tags, " "));
      if (unmet.size() < kMostNeeds && !unmet.contains(key)) unmet[key] = unmet_needs(needs);
      if (const auto known = unmet.find(key); known != unmet.end()) obstacle = known->second;
    }
    if (obstacle == active->obstacle) continue;
    active->obstacle = std::move(obstacle);
    active->touch();
  }
}

/// Frames, in order, that no light has reached.
template <class Frames>
void Diagnosis::explain_black(const Frames& frames, Reasons& reasons) {
  size_t told = 0;
  for (const int32_t frame : frames) {
    if (reasons.is_full()) break;
    reasons.say_one("frame {} is {}", frame, core::kBlackWords);
    ++told;
  }
  reasons.add(frames.size() - told);
  reasons.end_kind("frames are black all over");
}

void Diagnosis::explain_state(const ActiveJob& active, Reasons& reasons) const {
  if (disk_.level() != DiskLevel::roomy) {
    reasons.say(disk_.reason() +
                (disk_.level() == DiskLevel::full ? "; no units are leased and films have to wait"
                                                  : "; no units are leased") +
                " until there is room again (deleting jobs that have ended makes some)");
  }
  if (!active.trouble.empty()) reasons.say(active.trouble);
  if (!active.row_trouble.empty()) reasons.say(active.row_trouble);
  if (active.stored.state == StoredState::paused) {
    reasons.say("it is paused; 'resume' lets it go on");
  }
}

/// Whether somebody is there who may render it.
bool Diagnosis::explain_workers(const ActiveJob& active, bool anybody, Reasons& reasons) const {
  const std::string unmet = unmet_needs(active.needs);
  if (!anybody) reasons.say(kNobody);
  if (!unmet.empty()) reasons.say(unmet);
  if (anybody && unmet.empty()) return true;
  for (const std::string& barred : barred_workers()) reasons.say(barred);
  return false;
}

/// Whether some were begun by workers of which none is there, though others are.
bool Diagnosis::explain_frames(const ActiveJob& active, const std::set<std::string>& classes,
                               Reasons& reasons) const {
  for (const int32_t number : active.in_work) {
    if (active.frames.at(number).state != v1::FRAME_STATE_FINISHING) continue;
    reasons.say_one("frame {} is rendered; its outputs are being made", number);
  }
  reasons.end_kind("frames are rendered; their outputs are being made");
  size_t told = 0;
  for (const int32_t number : active.failed) {
    if (reasons.is_full()) break;
    reasons.say_one("frame {} failed: {}", number, *active.frames.at(number).reason);
    ++told;
  }
  reasons.add(active.failed.size() - told);
  reasons.end_kind("frames failed");
  bool orphans = false;
  for (const int32_t number : active.in_work) {
    const FrameNote& note = active.frames.at(number);
    if (note.state != v1::FRAME_STATE_RENDERING || classes.empty() || note.worker_class.empty() ||
        classes.contains(note.worker_class)) {
      continue;
    }
    orphans = true;
    reasons.say_one(
        "frame {} was begun by workers of class {}, and none of them is there; it "
        "begins again with another class {} s after the last one went",
        number, note.worker_class.substr(0, 12),
        std::chrono::duration_cast<std::chrono::seconds>(context_.options.class_patience).count());
  }
  reasons.end_kind("frames were begun by workers of classes of which none is there");
  return orphans;
}

/// What tiles are waited for that have samples, but not enough.
void Diagnosis::explain_noise(const ActiveJob& active, Reasons& reasons) const {
  if (!active.threshold.adaptive()) return;
  for (const int32_t number : active.in_work) {
    const FrameNote& note = active.frames.at(number);
    if (note.state != v1::FRAME_STATE_RENDERING || !note.noise) continue;
    reasons.say_one(
        "frame {} has a noise of {} on average; its tiles go on until the noisiest part of each "
        "has {}",
        number, core::format_noise(*note.noise), core::format_noise(active.threshold.aim.noise));
  }
  reasons.end_kind("frames have tiles that are noisier than the job asks for");
}

/// Whether some are out with workers.
bool Diagnosis::explain_units(const ActiveJob& active, bool anybody, Reasons& reasons) const {
  const Scheduler& scheduler = dispatcher_.scheduler();
  if (const uint32_t disputed = scheduler.disputed_units(active.id); disputed > 0) {
    reasons.say(fmt::format(
        "{} rendered differently by two workers of one class and {} for another worker of it to "
        "say who is right",
        core::counted(disputed, "unit") + (disputed == 1 ? " was" : " were"),
        disputed == 1 ? "waits" : "wait"));
  }
  if (const uint32_t once = scheduler.units_to_confirm(active.id); once > 0) {
    reasons.say(fmt::format(
        "{} {} for a second worker, let in by another token, to render {} too (--redundancy)",
        core::counted(once, "unit"), once == 1 ? "waits" : "wait", once == 1 ? "it" : "them"));
  }
  if (anybody && scheduler.waits_for_film(active.id)) {
    reasons.say(
        fmt::format("a frame waits for memory for its film of {}: those of frames in work, of all "
                    "jobs, take {} of {} (--film-memory)",
                    core::format_bytes(active.film_bytes), core::format_bytes(scheduler.films()),
                    core::format_bytes(context_.options.film_memory)));
  }
  for (const std::string& still : still_units(active.id)) reasons.say(still);
  if (scheduler.leased_units(active.id) == 0) return false;
  for (const std::string& where : where_units_are(active.id)) reasons.say(where);
  if (const uint32_t most = options_of(active.stored).max_workers(); most > 0) {
    reasons.say(fmt::format("at most {} may render it at once", core::counted(most, "worker")));
  }
  return true;
}

/// Who has the workers that could render it.
void Diagnosis::explain_rivals(const ActiveJob& active, Reasons& reasons) const {
  for (const auto& [other, rival] : jobs_.all()) {
    if (other != active.id && rival->stored.priority >= active.stored.priority &&
        dispatcher_.scheduler().leased_units(other) > 0) {
      reasons.say_one("job {} ({}, priority {}) has the workers now", rival->stored.id,
                      rival->stored.name, rival->stored.priority);
    }
  }
  reasons.end_kind("jobs have workers now");
  if (sessions_.is_adopting()) {
    reasons.say("the coordinator has just started and waits for its workers to come back");
  }
}

}  // namespace hyades::coordinator
