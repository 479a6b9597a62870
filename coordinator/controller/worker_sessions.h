#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/controller/worker_table.h"
#include "core/base/parallel.h"
#include "farm/byte_budget.h"
#include "farm/thread_pool.h"
#include "farm/token_term.h"

namespace hyades::coordinator {

class DiskWatch;
struct ResultRefusal;

/// With what a worker has come in.
struct WorkerPass {
  farm::TokenTerm term{};       ///< how long its token holds
  std::string credential{};     ///< WorkerJoined::credential
  std::string origin{};         ///< WorkerJoined::origin
  std::string machine_token{};  ///< Welcome::machine_token
  std::string owner{};          ///< who alone may come under the worker's id; empty: anybody
  std::string joined_with{};    ///< a token by which at most `machines` may be here; empty: none
  uint32_t machines = 0;
};

/// Workers that come, speak and go: their streams, heartbeats and leases on the wire. Thread-safe.
class WorkerSessions {
 public:
  WorkerSessions(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
                 WorkerTable& workers, const DiskWatch& disk)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        workers_(workers),
        disk_(disk),
        unpackers_(core::hardware_threads() > 2 ? core::hardware_threads() : 2, 10'000) {}

  /// A worker's stream begins; `link` gets the Welcome. An older stream of the same worker is
  /// closed, unless it is another process' that still speaks, or another owner's: ALREADY_EXISTS
  /// then. RESOURCE_EXHAUSTED where there are too many workers, in all or by one token;
  /// INVALID_ARGUMENT for a Hello that makes no sense.
  grpc::Status attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
                      WorkerId& worker, const WorkerPass& pass = {}) HYADES_EXCLUDES(state_lock);
  /// What came on the stream; what comes on one that is not the worker's newest is ignored.
  /// Films are unpacked by threads of their own, in turns of those who have let workers in; what
  /// comes on the stream meanwhile may be dealt with before them.
  void receive(WorkerId worker, const WorkerLink* link, v1::WorkerMessage message)
      HYADES_EXCLUDES(state_lock);
  /// A worker's stream has ended; does nothing where it is not the newest.
  void detach(WorkerId worker, const WorkerLink* link) HYADES_EXCLUDES(state_lock);
  /// Ends all streams.
  void close(const grpc::Status& why) HYADES_EXCLUDES(state_lock);

  /// From now on no new units are leased for a while, so that workers can say what they hold.
  void begin_adoption() HYADES_REQUIRES(state_lock);
  /// Whether that while is not over.
  bool is_adopting() const HYADES_REQUIRES(state_lock);
  /// Looks for workers that are gone, and grants what workers asked for during adoption; to be
  /// called from time to time.
  void look_after(Turn& turn) HYADES_REQUIRES(state_lock);

  // For the scheduler's actions.

  /// Tells the worker of units that are its own.
  void send_lease(const Lease& lease) HYADES_REQUIRES(state_lock);
  /// Tells the workers that know the job that they need it no more.
  void send_over(JobId job) HYADES_REQUIRES(state_lock);

 private:
  static constexpr uint64_t kMostPacked = uint64_t{512} << 20U;  ///< bytes

  v1::CoordinatorMessage welcome(const v1::Hello& hello, const WorkerPass& pass) const;
  bool has_room(Turn& turn) HYADES_REQUIRES(state_lock);
  grpc::Status may_join(const v1::Hello& hello, const WorkerPass& pass) const
      HYADES_REQUIRES(state_lock);
  grpc::Status resolve_duplicate_id(WorkerSession& session, const v1::Hello& hello)
      HYADES_REQUIRES(state_lock);
  void wait_for_more_holders() HYADES_REQUIRES(state_lock);
  void want(WorkerSession& session, uint32_t units, Turn& turn) HYADES_REQUIRES(state_lock);

  // What workers say (worker_messages.cpp, lease_renewal.cpp).
  size_t entries_heard(const WorkerSession& session) const HYADES_REQUIRES(state_lock);
  bool has(const WorkerSession& session, const v1::LeasedUnit& named, const core::Unit& unit) const
      HYADES_REQUIRES(state_lock);
  uint64_t longest_rendering(const WorkerSession& session, const v1::UnitResult& result,
                             const core::Unit& unit) const HYADES_REQUIRES(state_lock);
  void on_heartbeat(WorkerSession& session, const v1::Heartbeat& beat, Turn& turn)
      HYADES_REQUIRES(state_lock);
  void renew_leases(WorkerSession& session, const v1::Heartbeat& beat, Turn& turn)
      HYADES_REQUIRES(state_lock);
  void take_back(WorkerSession& session, const LeaseId& lease, const LeaseProgress& progress,
                 std::vector<Event>& events) HYADES_REQUIRES(state_lock);
  void on_failure(WorkerSession& session, const v1::UnitFailure& failure, Turn& turn)
      HYADES_REQUIRES(state_lock);
  void on_returned(WorkerSession& session, const v1::UnitsReturned& message, Turn& turn)
      HYADES_REQUIRES(state_lock);
  void on_leaving(WorkerSession& session, const v1::Leaving& leaving, Turn& turn)
      HYADES_REQUIRES(state_lock);
  /// A film that waits to be unpacked, or is.
  struct PendingResult;
  void on_result(WorkerId worker, const WorkerLink* link, v1::UnitResult result)
      HYADES_EXCLUDES(state_lock);
  void unpack(const std::shared_ptr<PendingResult>& pending) HYADES_EXCLUDES(state_lock);
  std::optional<ResultRefusal> not_now(const v1::UnitResult& result) HYADES_REQUIRES(state_lock);
  std::optional<ResultRefusal> have_unpacked(const std::shared_ptr<PendingResult>& pending,
                                             farm::ThreadPool& pool) HYADES_EXCLUDES(state_lock);
  void reject(WorkerSession& session, const v1::UnitResult& result, const ResultRefusal& refusal,
              Turn& turn) HYADES_REQUIRES(state_lock);
  std::optional<ResultRefusal> deliver(WorkerSession& session, const v1::UnitResult& result,
                                       Delivery& delivery, Turn& turn) HYADES_REQUIRES(state_lock);
  void refuse(WorkerSession& session, const v1::UnitResult& result, const ResultRefusal& refusal,
              Turn& turn) HYADES_REQUIRES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  const DiskWatch& disk_;
  TimePoint adopting_until_ HYADES_GUARDED_BY(state_lock);
  TimePoint adopting_at_most_ HYADES_GUARDED_BY(state_lock);

  /// Of films that wait to be unpacked, for who has let their workers in.
  farm::ByteBudget packed_{kMostPacked, kMostPacked / 2};

  // Last, so that they end first.
  farm::ThreadPool unpackers_;  ///< of films that take little memory
  farm::ThreadPool large_unpackers_{1, 1000};
};

}  // namespace hyades::coordinator
