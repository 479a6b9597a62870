#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coordinator/local/frame_work.h"
#include "coordinator/local/local_plan.h"
#include "coordinator/local/progress.h"
#include "coordinator/scheduler/scheduler.h"
#include "coordinator/store/film_store.h"

namespace hyades::coordinator {

/// A job on this machine: the farm's scheduler, with threads where the farm has workers. One thread
/// renders one unit; one loads the next frame while the last one's tail renders; one keeps films
/// (FilmStore); one finishes frames. Films are the same bits whatever the number of threads, the
/// tile size, and how often the run was stopped, killed and resumed.
class LocalRun : private FilmStore::Owner {
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

  Progress progress() const;

  /// After the run is over.
  LocalOutcome outcome() const;

 private:
  static constexpr JobId kJob{1};

  struct Task {
    core::Unit unit;
    LeaseId lease;
    std::shared_ptr<const FrameWork> work;
  };
  /// A render thread's seat.
  struct Seat {
    std::condition_variable wake;
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

  std::vector<Action> tell(const Event& event);
  std::vector<Action> tell_locked(const Event& event);
  void carry_out(const std::vector<Action>& actions);
  void act(const Persist& persist);
  void act(const Merge& merge);
  void act(const FinishFrame& finish);
  void act(const FrameDone& done);
  void act(const FrameFailed& failed);
  void act(const Reject& reject);
  void act(const JobEnded& ended);
  // tell_locked() has dealt with these.
  void act(const Lease&) {}
  void act(const OpenFrame&) {}
  // Threads do not forget, do not fall behind each other and are all of one machine.
  void act(const Revoke&) {}
  void act(const Acknowledge&) {}
  void act(const Conflict&) {}
  void act(const Quarantine&) {}
  void act(const Confirmed&) {}
  void act(const TileVoided&) {}
  void act(const FrameReopened&) {}
  void act(const FrameRestarted&) {}
  void end_locked(const std::string& error);
  /// The scheduler counts batches from the first that is rendered; renderer, films and log from the
  /// job's first.
  core::Unit to_render(core::Unit unit) const;
  uint64_t samples_of(const core::Unit& unit) const;
  uint64_t samples_per_frame() const;
  void count_locked(const core::Unit& unit, bool done);
  void note_film(int32_t frame, const core::Film& film);

  // FilmStore::Owner
  void persisted(RecordId record) override;
  void not_persisted(RecordId record, const std::string& reason) override;
  void try_again() override;
  void storage_failed(const std::string& reason) override;
  void drained() override;

  LocalPlan plan_;
  FrameSource& source_;
  FrameSink& sink_;
  FilmAudience* const audience_;
  std::vector<std::string> log_problems_;
  std::atomic<bool> stop_{false};  ///< seen by whoever renders or loads

  /// Everything up to the film store.
  mutable std::mutex mutex_;
  Scheduler scheduler_;
  std::vector<std::unique_ptr<Seat>> seats_;
  std::deque<int32_t> to_load_;
  std::condition_variable load_wake_;
  std::deque<Completed> to_finish_;
  std::condition_variable finish_wake_;
  std::condition_variable over_wake_;
  std::map<int32_t, std::shared_ptr<const FrameWork>> works_;
  std::map<int32_t, std::shared_ptr<const core::Film>> complete_;  ///< until their frame is over
  std::set<int32_t> in_flight_;
  std::map<int32_t, uint64_t> frame_samples_;  ///< done, of frames in flight
  Progress progress_;
  uint64_t samples_before_ = 0;  ///< done by earlier runs
  TimePoint started_;
  std::optional<TimePoint> first_lease_;
  TimePoint last_noise_;
  LocalOutcome outcome_;
  int rendering_ = 0;  ///< render threads that have not ended
  bool ending_ = false;
  bool over_ = false;

  FilmStore film_store_;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::coordinator
