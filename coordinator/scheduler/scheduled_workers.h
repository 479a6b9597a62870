#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "coordinator/scheduler/events.h"
#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// A connected worker.
struct Worker {
  /// A scene that it has begun with.
  struct Loading {
    FrameId frame;
    TimePoint since;
    bool alone = false;  ///< the worker had nothing else to do
  };

  Witness witness{};
  Origin origin{};
  uint32_t threads = 1;
  /// By RenderClass; 0: it renders nothing in that.
  std::array<ClassId, core::kRenderClassNames.size()> classes{};
  std::vector<TagId> tags;          ///< sorted
  uint64_t memory = 0;              ///< 0: no limit
  std::vector<FrameId> scenes;      ///< that it should have in memory, the latest last
  std::optional<FrameId> affinity;  ///< the frame that it renders and stays with
  std::optional<FrameId> prefetch;  ///< ... that it will render then; it has a unit of it already
  std::optional<Loading> loading;   ///< what it last began with, until the first film
  TimePoint joined;
  TimePoint in_line;                   ///< when it last got what was next in line
  std::optional<TimePoint> delivered;  ///< when a film of it last counted
  uint32_t wanted = 0;                 ///< units it asked for and did not get yet
  uint64_t waiting = 0;                ///< its place among those who wait, or 0
  bool barred = false;                 ///< gets nothing
  std::set<uint64_t> leases;
  uint32_t units = 0;  ///< that it has under all of them

  ClassId class_in(core::RenderClass which) const { return classes[static_cast<size_t>(which)]; }
  /// Its class in which the job is rendered.
  ClassId class_for(const ScheduledJob& job) const { return class_in(job.plan.needs.render_class); }
};

/// The connected workers: their classes and tags, who may render what, who waits for work; and what
/// stays when a worker goes: quarantine and failures.
class ScheduledWorkers {
 public:
  /// What a worker could not render and others could, without a unit of its own between.
  struct Failures {
    uint32_t count = 0;
    std::string reason;  ///< of the last unit that it failed
  };

  explicit ScheduledWorkers(const Step& step) : step_(step) {}

  Worker* find(WorkerId id);
  const Worker* find(WorkerId id) const;
  /// Adds a worker that is not there yet.
  Worker& add(const WorkerJoined& joined);
  /// Removes a worker that is there; what it had is the caller's business.
  void remove(WorkerId id);
  uint64_t threads() const { return threads_; }  ///< of all
  /// How many have what jobs ask for.
  uint64_t count(const Needs& needs) const;

  /// From now on the worker gets nothing, or gets units again.
  void bar(WorkerId id, Worker& worker, bool barred);
  bool quarantined(WorkerId id) const { return quarantined_.contains(id); }
  /// Puts a worker into quarantine, which stays when it goes and comes back. False where it is in
  /// it already.
  bool quarantine(WorkerId id) { return quarantined_.insert(id).second; }
  /// Ends its quarantine and forgets its failures.
  void pardon(WorkerId id);
  /// What the worker could not render, to be counted on.
  Failures& failures(WorkerId id) { return failures_[id]; }
  void forget_failures(WorkerId id);
  /// Notes that the worker gave units back: who does so more often than anybody has reason to
  /// rests, or nobody else would get any.
  void note_given_back(WorkerId id, uint32_t units);
  void forget_given_back(WorkerId id) { given_back_.erase(id); }
  /// Whether the worker rests, so that it gets nothing now.
  bool rests(WorkerId id) const;

  // Classes.

  /// The name of a class of which a worker is there.
  const std::string& name_of(ClassId worker_class) const { return classes_.at(worker_class).name; }
  /// Whether a class in which the job is rendered may be somebody's invention, so that others must
  /// not wait for it: all of it that may get units has one origin, or none, and others may get
  /// units too.
  bool is_lone(const ScheduledJob& job, ClassId worker_class) const;
  /// Where those of the class come from that may get units.
  std::vector<Origin> origins_of(ClassId worker_class) const;
  /// Whether a worker of another class is at work, or asks for some, that may begin with frames of
  /// the job, and that is not slow.
  bool anybody_of_another(const ScheduledJob& job, ClassId worker_class) const;
  /// A frame of the class stood still since `since`, while others could have rendered it. Its
  /// workers are slow until then, without those that delivered something meanwhile and are none of
  /// `holders`, who have had units of the frame all the time. So is whoever of the same origin
  /// comes later, where others are left.
  void note_slow(ClassId worker_class, TimePoint since, const std::vector<WorkerId>& holders,
                 TimePoint until);
  /// Forgets who is slow no more. Whether there was somebody.
  bool forgive_slow();
  /// Whether somebody who is not slow and at work could render the frame, which was left by
  /// `slot.left`, with a better claim than `worker`: one of an origin that did not leave it, else
  /// of a class that did not.
  bool anybody_with_better_claim(const ScheduledJob& job, const FrameSlot& slot,
                                 const Worker& worker) const;
  /// Whether units of the frame are for the worker's class: it has begun it, or nobody has. Who is
  /// slow begins only what nobody else can, and so does whoever has left the frame before.
  bool may_render(const ScheduledJob& job, const FrameSlot& slot, const Worker& worker) const;

  /// Whether the worker has what the job asks for, and the job's limit leaves room for it.
  static bool may_join(const ScheduledJob& job, WorkerId id, const Worker& worker);
  /// Whether a worker of the class may get units of the job.
  bool anybody_for(const ScheduledJob& job, ClassId worker_class) const;
  /// Whether a worker of the class is there that may get units of the job, is none of `tried`,
  /// which is sorted, and has none of the witnesses that were `heard`.
  bool anybody_besides(const std::vector<WorkerId>& tried, const std::vector<Witness>& heard,
                       const ScheduledJob& job, ClassId worker_class) const;
  /// Whether the worker may get a unit that has failed with `blamed`: not as one of them, as long
  /// as somebody is there who has not failed it, and whose witness was not `heard`.
  bool may_try(const ScheduledJob& job, WorkerId id, const Worker& worker,
               const std::vector<WorkerId>& blamed, const std::vector<Witness>& heard = {}) const;

  /// To be called when its wish has changed.
  void update_waiting(WorkerId id, Worker& worker);
  /// Those with a wish, longest waiting first.
  const std::map<uint64_t, WorkerId>& waiting() const { return waiting_; }

 private:
  /// What a worker gave back since its last film, whether it said so or came anew without it.
  struct GivenBack {
    uint32_t units = 0;
    TimePoint rests_until;  ///< it gets nothing before
  };
  /// A class of which some worker is connected.
  struct Class {
    std::string name;
    core::RenderClass of = core::RenderClass::native;
    uint32_t connected = 0;
    std::set<WorkerId> able;             ///< those that may get units
    std::map<Origin, uint32_t> origins;  ///< of these: how many of each
  };

  static bool suits(const ScheduledJob& job, const Worker& worker);
  void join_class(Worker& worker, core::RenderClass which, const std::string& name);
  void count_able(WorkerId id, const Worker& worker, bool one_more);
  bool is_slow(const Worker& worker) const;

  const Step& step_;
  std::unordered_map<WorkerId, Worker> workers_;  ///< looked up; walked only where order is nothing
  uint64_t threads_ = 0;
  std::set<WorkerId> quarantined_;
  std::map<WorkerId, Failures> failures_;
  std::map<WorkerId, GivenBack> given_back_;
  std::map<uint64_t, WorkerId> waiting_;
  uint64_t next_waiting_ = 1;
  std::map<ClassId, Class> classes_;
  /// By RenderClass: those that have origins.
  std::array<size_t, core::kRenderClassNames.size()> classes_at_work_{};
  std::map<Witness, TimePoint> slow_witnesses_;  ///< until when
  struct SlowOrigin {
    TimePoint since;  ///< those who came before are not meant
    TimePoint until;
  };
  std::map<Origin, SlowOrigin> slow_origins_;
};

/// The class of this name, by a hash: a table of names could be filled by whoever invents many.
ClassId class_id(core::RenderClass of, const std::string& name);
/// The tags of these names, by their hashes; sorted, each once.
std::vector<TagId> tag_ids(const std::vector<std::string>& tags);

}  // namespace hyades::coordinator
