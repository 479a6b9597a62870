#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "coordinator/film_store/film_store.h"
#include "coordinator/local/frame_work.h"
#include "coordinator/local/local_plan.h"
#include "coordinator/local/progress.h"
#include "coordinator/scheduler/scheduler.h"
#include "core/base/mutex.h"

namespace hyades::coordinator {

/// A job on this machine: the farm's scheduler, with threads where the farm has workers. One thread
/// renders one unit; one loads the next frame while the last one's tail renders; one keeps films
/// (FilmStore); one finishes frames. Films are the same bits whatever the number of threads and how
/// often the run was stopped, killed and resumed; without a threshold also whatever the tile size.
class LocalRun : private FilmStore::Listener {
 public:
  /// `source`, `sink` and `audience`, which may be null, outlive the run.
  LocalRun(LocalPlan plan, const FilmStoreOptions& log, FrameSource& source, FrameSink& sink,
           FilmAudience* audience = nullptr);
  /// Stops, and waits for all threads, also for a frame that is being loaded or finished.
  ~LocalRun() override;

  /// Reads what the log holds and starts. An error where the log cannot be used; nothing runs then.
  core::Status start();

  /// What was wrong with the log, in words; it costs rendering again. Valid after start().
  const std::vector<std::string>& log_problems() const { return log_problems_; }

  /// Ends the run soon: units being rendered are given up, finished ones made durable. Not to be
  /// called from a signal handler.
  void stop();

  /// Waits until the run is over, at most for `duration`, and returns whether it is. After stop() a
  /// frame may still be loading or finishing in the background; leaving the process does no harm,
  /// for all that matters is durable and outputs appear whole or not at all.
  bool wait_for(Duration duration);

  /// How far earlier runs had come. Valid after start().
  const Progress& before() const { return before_; }

  /// How far the run is now.
  Progress progress() const;

  /// The frames that were finished since the last call, in that order.
  std::vector<FrameTime> take_finished();

  /// How the run ended; to be asked once it is over.
  LocalOutcome outcome() const;

 private:
  static constexpr JobId kJob{1};

  /// What is done of the scheduler's actions without the lock, in their order.
  using DeferredAction =
      std::variant<Persist, Merge, FinishFrame, FrameDone, FrameFailed, Reject, JobEnded>;

  struct Task {
    core::Unit unit;
    LeaseId lease;
    std::shared_ptr<const FrameWork> work;
  };
  /// What a render thread is to render next.
  struct TaskQueue {
    core::CondVar wake;
    std::deque<Task> tasks;
  };
  struct Completed {
    int32_t frame = 0;
    std::shared_ptr<const core::Film> film;
  };

  void render_loop(int thread);
  void load_loop();
  void finish_loop();
  std::optional<Task> next_task(int thread);
  void deliver(int thread, const Task& task, core::Film film, Duration render_time);

  JobAdded recover(const LogContents& contents) HYADES_REQUIRES(mutex_);
  void restore(const LogContents& contents, int32_t frame, RestoredJob& restored)
      HYADES_REQUIRES(mutex_);

  std::vector<DeferredAction> tell(const Event& event);
  std::vector<DeferredAction> tell_locked(const Event& event) HYADES_REQUIRES(mutex_);
  void hand_out(const Lease& lease) HYADES_REQUIRES(mutex_);
  void carry_out(const std::vector<DeferredAction>& actions);
  void judge_later(const JudgeTile& judge);
  void spare(const TileSpared& spared) HYADES_REQUIRES(mutex_);
  void act(const Persist& persist);
  void act(const Merge& merge);
  void act(const FinishFrame& finish);
  void act(const FrameDone& done);
  void act(const FrameFailed& failed);
  void act(const Reject& reject);
  void act(const JobEnded& ended);
  void end_locked(const std::string& error) HYADES_REQUIRES(mutex_);
  /// The scheduler counts batches from the first that is rendered; renderer, films and log from the
  /// job's first.
  core::Unit to_render(core::Unit unit) const;
  uint64_t samples_of(const core::Unit& unit) const;
  uint64_t samples_per_frame() const;
  void count_locked(const core::Unit& unit, bool done) HYADES_REQUIRES(mutex_);
  void note_film(int32_t frame, const core::Film& film);

  // FilmStore::Listener
  void persisted(RecordId record) override;
  void not_persisted(RecordId record, const std::string& reason) override;
  void outgrown(int32_t frame, const std::string& reason) override;
  void try_again() override;
  void storage_failed(const std::string& reason) override;
  void drained() override;

  LocalPlan plan_;
  FrameSource& source_;
  FrameSink& sink_;
  FilmAudience* const audience_;
  std::vector<std::string> log_problems_;
  Progress before_;
  std::atomic<bool> stop_{false};  ///< seen by whoever renders or loads

  /// Everything up to the film store.
  mutable core::Mutex mutex_;
  Scheduler scheduler_ HYADES_GUARDED_BY(mutex_);
  std::vector<std::unique_ptr<TaskQueue>> task_queues_ HYADES_GUARDED_BY(mutex_);
  std::deque<int32_t> to_load_ HYADES_GUARDED_BY(mutex_);
  core::CondVar load_wake_;
  std::deque<Completed> to_finish_ HYADES_GUARDED_BY(mutex_);
  core::CondVar finish_wake_;
  core::CondVar over_wake_;
  std::map<int32_t, std::shared_ptr<const FrameWork>> works_ HYADES_GUARDED_BY(mutex_);
  std::map<int32_t, std::shared_ptr<const core::Film>> complete_
      HYADES_GUARDED_BY(mutex_);  ///< until their frame is over
  std::set<int32_t> in_flight_ HYADES_GUARDED_BY(mutex_);
  std::map<int32_t, TimePoint> begun_ HYADES_GUARDED_BY(mutex_);  ///< frames in flight
  std::vector<FrameTime> finished_ HYADES_GUARDED_BY(mutex_);
  std::set<int32_t> outgrown_ HYADES_GUARDED_BY(mutex_);  ///< frames that fail for that
  std::map<int32_t, uint64_t> frame_samples_
      HYADES_GUARDED_BY(mutex_);  ///< done, of frames in flight
  std::map<int32_t, uint64_t> spared_samples_
      HYADES_GUARDED_BY(mutex_);                   ///< not needed, of frames in flight
  uint64_t spared_ HYADES_GUARDED_BY(mutex_) = 0;  ///< samples not needed, of all frames
  Progress progress_ HYADES_GUARDED_BY(mutex_);
  uint64_t samples_before_ HYADES_GUARDED_BY(mutex_) = 0;  ///< done by earlier runs
  TimePoint started_ HYADES_GUARDED_BY(mutex_);
  std::optional<TimePoint> first_lease_ HYADES_GUARDED_BY(mutex_);
  TimePoint last_noise_;  ///< of the store's thread
  LocalOutcome outcome_ HYADES_GUARDED_BY(mutex_);
  int rendering_ HYADES_GUARDED_BY(mutex_) = 0;  ///< render threads that have not ended
  bool ending_ HYADES_GUARDED_BY(mutex_) = false;
  bool over_ HYADES_GUARDED_BY(mutex_) = false;

  FilmStore film_store_;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::coordinator
