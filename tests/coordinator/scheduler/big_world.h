#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduler.h"
#include "tests/coordinator/scheduler/simulated_types.h"

namespace hyades::coordinator {

struct BigWorldOptions {
  uint64_t seed = 1;
  size_t workers = 10'000;
  uint32_t threads = 4;  ///< of each
  size_t jobs = 30;
  size_t owners = 6;
  int frames = 20;  ///< of each job
  core::PixelRect region{0, 0, 1920, 1080};
  uint32_t batches = 64;       ///< of 16 samples
  double batch_seconds = 0.5;  ///< of one thread for a batch of a tile, in the mean
  double scene_seconds = 6;    ///< to load a frame's scene
  double preempted_per_minute = 0.01;
  Duration unit_time = std::chrono::seconds(5);
};

/// Where the threads' time went, in seconds of one thread.
struct ThreadTime {
  double there = 0;      ///< of workers that were there: the sum of the next four
  double rendering = 0;  ///< of which `lost` does not count
  double starting = 0;   ///< from a worker's start to its first unit
  double loading = 0;    ///< with a unit whose scene was not there yet
  double starved = 0;    ///< without a unit
  double lost = 0;       ///< rendered for nothing: pre-empted, or another's copy was first
  double efficiency() const { return (rendering - lost) / there; }
};

/// What the threads that are there do at one moment.
struct Moment {
  double at = 0;
  size_t threads = 0;
  size_t rendering = 0;
  size_t loading = 0;  ///< with a unit whose scene is not there yet
  size_t starved = 0;  ///< without a unit
};

/// What happened, in seconds of simulated time where nothing else is said.
struct BigWorldReport {
  double duration = 0;
  double enough_until = 0;  ///< when the tail began
  ThreadTime enough;        ///< while there was enough work, with the start
  ThreadTime tail;          ///< after that
  double counted = 0;       ///< thread seconds in which what counts was rendered
  uint64_t units = 0;
  uint64_t scenes_loaded = 0;
  uint64_t preempted = 0;
  uint64_t frames_done = 0;
  uint64_t events = 0;     ///< that the scheduler has answered
  double cpu_seconds = 0;  ///< of this machine for them
  std::deque<Moment> end;  ///< the last seconds, one by one
  double thread_seconds() const { return enough.there + tail.there; }
  double efficiency() const { return counted / thread_seconds(); }
};

/// Tells on standard output where the time went.
void print(const BigWorldReport& report);

/// A big farm on a good day: the real scheduler, thousands of workers, realistic links, unit times
/// and scenes, workers pre-empted by rate. What a worker does is what worker/state_machine.h does:
/// as many units wait as it has threads, the wish for the next travels with a result, heartbeats
/// every five seconds, one scene is loaded at a time beside what is rendered. Efficiency is
/// rendering that counts over the time that threads were there, from the first worker's start to
/// the last frame's end; `enough` is the same up to the moment when less is left to render than
/// what fills all threads and their queues (two units each): no order of work could keep all of
/// them busy after that. Deterministic, except for `cpu_seconds`. Throws a std::string where a
/// batch counts twice, or a frame ends without one.
class BigWorld {
 public:
  explicit BigWorld(const BigWorldOptions& options);
  BigWorldReport run();

 private:
  struct Unit {
    JobId job{};
    LeaseId lease;
    core::Unit unit;
    double seconds = 0;  ///< that this worker's thread will take
    double began = -1;   ///< -1: it waits
    uint64_t number = 0;
  };
  struct Machine {
    bool there = false;
    uint64_t life = 0;
    WorkerId id{};
    double speed = 1;
    double link = 0;           ///< seconds one way
    double since = 0;          ///< its time up to then is in the report
    bool begun = false;        ///< has begun a unit in this life
    double loads_until = 0;    ///< it loads scenes, one after the other
    bool looks_again = false;  ///< when a scene is there
    uint32_t asked = 0;
    std::vector<Unit> units{};  ///< in work first, then those that wait
    std::vector<std::pair<std::pair<JobId, int32_t>, double>>
        scenes{};  ///< and when they are there
  };
  using Film = std::vector<uint64_t>;  ///< one bit for each batch of a tile

  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double seconds_now() const {
    return std::chrono::duration<double>(now_.time_since_epoch()).count();
  }
  void after(double seconds, std::function<void()> what);
  void tell(const Event& event);
  template <class Message>
  void send(WorkerId id, Message message);

  void account(Machine& machine);
  void look_whether_enough();
  void look_at_the_clock();
  void start(size_t machine);
  void leave(size_t machine);
  void beat(size_t machine, uint64_t life);
  void ask(Machine& machine, bool with_result);
  void begin(size_t machine);
  void done(size_t machine, uint64_t number);
  void deliver(Machine& machine, const Unit& unit, bool ask);
  double scene_at(Machine& machine, JobId job, int32_t frame);
  double cost(JobId job, const core::Unit& unit) const;

  void act(const Lease& lease);
  void act(const Revoke& revoke);
  void act(const Persist& persist);
  void act(const Merge& merge);
  void act(const FinishFrame& finish);
  void act(const JobEnded& ended);
  void act(const OpenFrame& open);
  void act(const FrameDone&) { ++report_.frames_done; }
  void act(const FrameFailed& failed) { throw "a frame failed: " + failed.reason; }
  template <class Other>
  void act(const Other&) {}

  const BigWorldOptions options_;
  std::mt19937_64 random_;
  Scheduler scheduler_;
  TimePoint now_;
  uint64_t serial_ = 0;
  std::priority_queue<Happening> events_;
  std::vector<Machine> machines_;
  std::map<WorkerId, size_t> machine_of_;
  uint64_t next_worker_ = 1;
  std::map<std::pair<JobId, int32_t>, std::map<std::pair<int32_t, int32_t>, Film>> films_;
  std::map<RecordId, double> took_;  ///< thread seconds of films on their way to the disk
  double arriving_ = 0;              ///< ... of the one that has just come
  std::vector<RecordId> syncing_;
  size_t open_jobs_ = 0;
  bool woken_ = false;
  double to_render_ = 0;  ///< thread seconds on a machine of speed 1 that are not merged yet
  double threads_there_ = 0;
  ThreadTime* phase_ = &report_.enough;
  BigWorldReport report_;
};

}  // namespace hyades::coordinator
