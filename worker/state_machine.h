#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "farm/backoff.h"
#include "farm/log.h"
#include "hyades/v1/work.pb.h"
#include "worker/files_trouble.h"
#include "worker/pipe/render_pipe.pb.h"
#include "worker/unit_clock.h"

namespace hyades::worker {

using TimePoint = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;

/// What a StateMachine has done by others. Nothing here calls back into the state machine before it
/// returns.
class WorkerPorts {
 public:
  virtual ~WorkerPorts() = default;

  /// To the coordinator, on the stream that is open.
  virtual void send(v1::WorkerMessage message) = 0;
  /// The stream that is open shall end: the coordinator says what none should. For the machine it
  /// is closed already.
  virtual void break_off(const std::string& reason) = 0;
  /// To the rendering child; lost if there is none.
  virtual void tell_renderer(pipe::ToRenderer message) = 0;
  /// It hangs. `reason` completes "the process that renders ...". When it is dead
  /// StateMachine::renderer_died is called as always.
  virtual void kill_renderer(const std::string& reason) = 0;
  /// Brings the job's files into the cache; answered by StateMachine::files_are_there or
  /// files_failed.
  virtual void fetch(uint64_t job, const v1::JobSpec& spec) = 0;
  /// The child has found this file of the cache (by its name there) damaged: to be looked at before
  /// it is used again.
  virtual void recheck(const std::string& file) = 0;
  /// No unit of the job is left: its files may be evicted. What was being fetched is broken off,
  /// and answered only where the answer is on its way already.
  virtual void release(uint64_t job) = 0;
  /// Whether all files of the job were fetched and not released since.
  virtual bool has_files(uint64_t job) = 0;
  /// For people.
  virtual void note(farm::LogLevel level, const std::string& text,
                    const farm::LogFields& about) = 0;
};

/// The cache of assets on the disk; see Heartbeat.
struct CacheFacts {
  uint64_t bytes = 0;
  uint64_t limit_bytes = 0;  ///< 0: none
  uint64_t hits = 0;
  uint64_t misses = 0;
};

/// What this worker is; see Hello.
struct StateMachineOptions {
  std::string worker_id;
  std::string instance;  ///< random, of this process
  std::string name;
  std::string host;
  uint32_t threads = 1;
  uint32_t ahead = 1;  ///< units that wait so that no thread ever does
  uint64_t memory_bytes = 0;
  std::vector<std::string> tags;
  /// Films that may wait for their acknowledgement before no more work is asked for.
  uint64_t max_kept_bytes = uint64_t{1} << 30U;
  size_t max_kept = 10'000;  ///< the same in numbers
  /// Of jobs that the coordinator told of, each with kBriefBytes more. As much as all open jobs of
  /// a farm may have (docs/wire.md): no coordinator that means well comes to that.
  uint64_t max_brief_bytes = uint64_t{128} << 20U;
  Duration hang_limit{0};  ///< see UnitClock
  Duration unit_limit{0};  ///< see UnitClock
};

/// All that a worker decides: which units it has under which leases, who renders what, which films
/// are not acknowledged yet. Deterministic: no threads, no clock, no input or output.
///
/// A unit is in hand from its lease on until its film is acknowledged or refused for good, it has
/// failed, or it was given back. Streams come and go; what is in hand stays, and is told to the
/// coordinator in the next Hello.
///
/// When the rendering child dies, every unit that it had begun is a suspect. Suspects are rendered
/// again one at a time, with nothing beside them: the one that kills the child alone has failed. A
/// child that hangs is killed, and then only the units that it hung in are suspects. A unit that
/// takes longer than it may has failed, whoever is to blame. A child whose answer fits none of its
/// units is killed, and they are suspects as when it dies.
///
/// A coordinator gets no more memory than one that means well needs: it welcomes once, leases no
/// more units than it was asked for, and tells of no more jobs than fit; else its stream is ended.
class StateMachine {
 public:
  StateMachine(StateMachineOptions options, WorkerPorts& ports)
      : options_(std::move(options)),
        ports_(ports),
        clock_(options_.hang_limit, options_.unit_limit),
        rests_(kFirstRest, kLongestRest,
               static_cast<uint32_t>(std::hash<std::string>{}(options_.worker_id))) {}

  /// Another worker is known by this one's id: from the next stream on it has another.
  void rename(const std::string& worker_id) { options_.worker_id = worker_id; }

  // The rendering child.
  void renderer_started();
  void renderer_ready(const pipe::Ready& ready);
  void renderer_says(const pipe::FromRenderer& message);
  /// `reason` in words: "was killed by signal 11 (Segmentation fault)".
  void renderer_died(const std::string& reason);

  // The stream to the coordinator.
  void stream_opened(TimePoint now);
  void coordinator_says(v1::CoordinatorMessage message, TimePoint now);
  void stream_closed();

  // The job's files.
  void files_are_there(uint64_t job);
  /// The units that wait for them have failed, or go back. Then there is a rest, which grows with
  /// each failure until files are there again: of the job's trouble it is the job's alone, whose
  /// units are held as they come, a few, and the others' go on; of the machine's it is the
  /// worker's, and no more work is asked for.
  void files_failed(uint64_t job, const std::string& why, FilesTrouble trouble, TimePoint now);

  /// What heartbeats tell of the cache from now on.
  void cache_is(const CacheFacts& cache) { cache_ = cache; }

  /// Heartbeats, leases that ran out, films to be sent again. To be called at least every 100 ms.
  /// `flowing`: what was sent before has left, so that a heartbeat reaches the coordinator.
  void tick(TimePoint now, bool flowing);

  /// Takes no more work. With `hand_over` units in work stop at once and the batches that are done
  /// are delivered; otherwise what is leased is finished.
  void leave(const std::string& reason, bool hand_over);
  /// Every unit that nobody works on goes back to the coordinator.
  void give_back_rest(const std::string& reason);

  bool leaving() const { return leaving_; }
  /// Whether nothing is in hand any more.
  bool empty() const { return items_.empty(); }
  /// Units, those included whose films wait for their acknowledgement.
  size_t in_hand() const { return items_.size(); }
  size_t unacknowledged() const { return kept_; }
  /// Whether the coordinator has said Welcome on the stream that is open.
  bool attended() const { return welcomed_; }

 private:
  struct Item {
    enum class State : uint8_t { fetching, waiting, rendering, kept };
    v1::LeasedUnit leased;
    State state = State::fetching;
    bool begun = false;    ///< the child has said Started
    bool loading = false;  ///< ... its scene
    bool suspect = false;  ///< it was begun when a child died
    uint64_t samples_done = 0;
    v1::UnitResult result;  ///< of a kept film
    std::optional<TimePoint> send_again;
  };
  struct Job {
    explicit Job(uint32_t seed) : rests(kFirstRest, kLongestJobRest, seed) {}

    std::string spec;        ///< a v1::JobSpec as it travels, which takes a fraction of the memory
    bool spec_sent = false;  ///< on the stream that is open
    bool has_files = false;
    bool fetching = false;
    bool told = false;  ///< the child knows it
    bool over = false;
    // Its files cannot be had.
    farm::Backoff rests;
    std::optional<TimePoint> rests_until;  ///< its units are held until then
    std::string trouble;                   ///< told to people
    std::string hopeless;                  ///< why this worker will never have them
  };
  using Items = std::map<uint64_t, Item>;
  /// A Backoff waits for at least half of these.
  static constexpr std::chrono::seconds kFirstRest{10};
  static constexpr std::chrono::seconds kLongestRest{120};
  static constexpr std::chrono::seconds kLongestJobRest{30};  // units that are held are nobody's
  static constexpr uint64_t kBriefBytes = uint64_t{6} << 10U;

  // state_machine.cpp: the units in hand.
  static farm::LogFields about(const v1::LeasedUnit& leased);
  Items::iterator find(const v1::LeasedUnit& leased);
  void keep_film(Items::iterator item, const pipe::UnitFilm& film);
  void fail(Items::iterator item, const std::string& reason);
  void drop(Items::iterator item);
  void stop_rendering(Items::iterator item);

  // state_machine_stream.cpp: what the coordinator says and is asked for.
  void break_off(const std::string& reason);
  void send_hello();
  void welcomed(const v1::Welcome& welcome, TimePoint now);
  void add_job(const v1::JobBrief& brief);
  void forget_former_jobs();
  void job_over(uint64_t job);
  void take(const v1::Lease& lease, TimePoint now);
  void take_unit(const v1::LeasedUnit& leased, bool adopted, TimePoint now);
  void give_back(const v1::LeasedUnit& leased, const std::string& reason);
  void acknowledged(const v1::LeasedUnit& unit);
  void unwanted(const v1::LeasedUnit& unit);
  void rejected(const v1::Rejected& message, TimePoint now);
  void send_result(const Item& item);
  size_t enough() const { return size_t{options_.threads} + options_.ahead; }
  uint32_t take_wish();
  void top_up();

  // state_machine_renderer.cpp: what the rendering child says and is given.
  Items::iterator in_work(uint64_t token);
  void progressed(const pipe::Progress& progress);
  void started(const pipe::Started& started);
  bool rendered(const pipe::UnitFilm& film);
  void failed(const pipe::UnitFailed& failed);
  void stopped(uint64_t token);
  void distrust(const std::string& reason);
  void lose_renderer(const std::string& reason, const std::set<uint64_t>* hung);
  void end_hang();
  void end_overdue();
  void dispatch();
  void tell_child(uint64_t token, Item& item);

  // state_machine_files.cpp: the files of jobs.
  void fetch_files(uint64_t id, Job& job);
  size_t held() const;
  void end_rests(TimePoint now);
  void recheck_files(uint64_t job, const pipe::UnitFailed& failed);
  static v1::JobSpec spec_of(const Job& job);
  static uint64_t bytes_of(const Job& job) { return job.spec.size() + kBriefBytes; }
  void forget_idle_job(uint64_t job);

  // state_machine_time.cpp: because time has passed.
  static v1::LeaseProgress::Stage stage_of(const Item& item);
  void fence(TimePoint now);
  void heartbeat(TimePoint now);
  void echoed(uint64_t number);

  // state_machine_leave.cpp: leaving.
  void drained(const std::string& why);
  void say_leaving();

  StateMachineOptions options_;
  WorkerPorts& ports_;
  Items items_;  ///< by token
  std::map<uint64_t, Job> jobs_;
  uint64_t brief_bytes_ = 0;  ///< of these
  uint64_t next_token_ = 1;
  size_t kept_ = 0;  ///< items with a film
  uint64_t kept_bytes_ = 0;

  std::string worker_class_;
  std::string portable_class_;
  std::string build_;
  bool renderer_up_ = false;
  UnitClock clock_;
  uint64_t renderer_memory_ = 0;
  CacheFacts cache_;

  // Files cannot be had on this machine.
  farm::Backoff rests_;
  std::optional<TimePoint> rests_until_;  ///< asks for no work, and takes none that needs files
  std::string files_trouble_;             ///< told to people
  std::optional<TimePoint> asks_again_;   ///< more units came of jobs that rest than are held

  bool open_ = false;
  bool welcomed_ = false;
  uint64_t wished_ = 0;         ///< units asked for on this stream that have not come
  uint64_t to_be_adopted_ = 0;  ///< units that Hello told of and that no lease has named
  Duration heartbeat_every_{std::chrono::seconds(5)};
  Duration lease_time_{std::chrono::seconds(30)};
  uint64_t max_message_bytes_ = uint64_t{64} << 20U;
  /// When what last renewed the leases, as far as is known from the coordinator's answer, was sent.
  std::optional<TimePoint> renewed_;
  TimePoint hello_sent_;
  TimePoint last_heartbeat_;
  uint64_t heartbeats_ = 0;
  std::map<uint64_t, TimePoint> unanswered_;  ///< heartbeats on this stream: when they were sent
  bool leaving_ = false;
  bool handing_over_ = false;  ///< nothing more is rendered
  std::string leaving_reason_;
};

}  // namespace hyades::worker
