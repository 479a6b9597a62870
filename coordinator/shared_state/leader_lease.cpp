#include "coordinator/shared_state/leader_lease.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/shared_state/lease_rows.h"
#include "coordinator/sql/postgres.h"

namespace hyades::coordinator {
namespace {

using std::chrono::milliseconds;

/// Of the lease's time: how often it is renewed, and how often stand-bys look.
constexpr int kRenewalsPerLease = 6;
constexpr int kLooksPerLease = 10;
constexpr milliseconds kSoon{20};
constexpr milliseconds kShortestPatience{1000};
constexpr milliseconds kLookAgain{1000};  ///< where nothing is known of a lease

std::string name_of(uint64_t incarnation) { return "hyades leader " + std::to_string(incarnation); }

/// Ends what the leader that is gone may have open: a frozen one's transaction would be waited for.
void end_sessions(SqlConnection& db, uint64_t incarnation) {
  (void)Query(db,
              "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = ? "
              "AND datname = current_database() AND usename = current_user")
      .bind(name_of(incarnation))
      .run();
}

/// Looks again and again until this process leads.
class Candidate {
 public:
  explicit Candidate(const LeaderOptions& options) : options_(options) {}

  /// The incarnation; nothing where it was ended.
  core::Result<std::optional<uint64_t>> run() {
    for (bool first = true;; first = false) {
      const auto led = look();
      if (led && *led) return led;
      if (!led) {
        db_.reset();
        if (first && !options_.patient) return led.error();
      }
      tell(led ? std::string() : led.error().message);
      const milliseconds again = led ? std::max(row_.time / kLooksPerLease, kSoon) : kLookAgain;
      if (!options_.pause(again)) return std::optional<uint64_t>();
    }
  }

  /// When the last attempt to take over began.
  LeaderWatch::TimePoint tried() const { return tried_; }

  /// Tells what is news.
  void tell(const std::string& trouble) {
    const bool news = !told_ || told_->incarnation != row_.incarnation || told_->url != row_.url;
    if (!news && trouble == told_trouble_) return;
    told_ = row_;
    told_trouble_ = trouble;
    if (options_.tell) options_.tell(row_, trouble);
  }

 private:
  core::Result<std::optional<uint64_t>> look() {
    if (!db_) {
      PostgresOptions postgres;
      postgres.url = options_.database;
      postgres.name = "hyades stand-by";
      postgres.patience = std::max(options_.time, kShortestPatience);
      auto opened = open_postgres(postgres);
      if (!opened) return opened.error();
      db_ = std::move(*opened);
      if (core::Status made = prepare_postgres(*db_); !made) return made.error();
    }
    auto row = read_lease(*db_);
    if (!row) return row.error();
    row_ = std::move(*row);
    tried_ = std::chrono::steady_clock::now();
    if (!watch_.is_gone(row_, tried_)) return std::optional<uint64_t>();
    // The schema may have become newer since this process began to stand by.
    if (core::Status known = prepare_postgres(*db_); !known) return known.error();
    if (row_.incarnation > 0) end_sessions(*db_, row_.incarnation);
    return take_over(*db_, row_, options_.holder, options_.time);
  }

  const LeaderOptions& options_;
  std::unique_ptr<SqlConnection> db_;
  LeaderWatch watch_;
  LeaderWatch::TimePoint tried_;
  LeaseRow row_;
  std::optional<LeaseRow> told_;
  std::string told_trouble_;
};

}  // namespace

core::Result<std::unique_ptr<LeaderLease>> LeaderLease::wait(const LeaderOptions& options) {
  Candidate candidate(options);
  while (true) {
    const auto led = candidate.run();
    if (!led) return led.error();
    if (!*led) return std::unique_ptr<LeaderLease>();
    std::unique_ptr<LeaderLease> lease(new LeaderLease(options, **led, candidate.tried()));
    auto db = open_postgres(leader_connection(options.database, **led, {}));
    const core::Status ready = db ? migrate_postgres(**db) : db.error();
    if (ready) return lease;
    if (!options.patient) return ready.error();
    lease.reset();
    candidate.tell(ready.error().message);
    if (!options.pause(kLookAgain)) return std::unique_ptr<LeaderLease>();
  }
}

PostgresOptions leader_connection(const std::string& database, uint64_t incarnation,
                                  std::function<void(const std::string& why)> on_lost) {
  PostgresOptions options;
  options.url = database;
  options.name = name_of(incarnation);
  options.incarnation = incarnation;
  options.on_lost = std::move(on_lost);
  return options;
}

LeaderLease::LeaderLease(LeaderOptions options, uint64_t incarnation, TimePoint begun)
    : options_(std::move(options)),
      incarnation_(incarnation),
      renewed_(begun),
      renewals_([this] { renew(); }),
      watch_([this] { watch(); }) {}

LeaderLease::~LeaderLease() {
  {
    const core::MutexLock lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  renewals_.join();
  watch_.join();
  {
    const core::MutexLock lock(mutex_);
    if (lost_) return;
  }
  auto db = open_postgres(leader_connection(options_.database, incarnation_, {}));
  // Where this fails others take over after the lease's time.
  if (db) (void)step_down(**db, incarnation_);
}

void LeaderLease::set_url(const std::string& url) {
  const core::MutexLock lock(mutex_);
  url_ = url;
}

void LeaderLease::renew_while(std::function<bool()> works) {
  const core::MutexLock lock(mutex_);
  works_ = std::move(works);
}

bool LeaderLease::holds() const {
  const core::MutexLock lock(mutex_);
  return !lost_ && std::chrono::steady_clock::now() < end();
}

LeaderLease::TimePoint LeaderLease::end() const { return renewed_ + options_.time * 4 / 5; }

void LeaderLease::lose(const std::string& why) {
  {
    const core::MutexLock lock(mutex_);
    if (lost_ || ends_) return;
    lost_ = true;
  }
  wake_.notify_all();
  if (options_.on_lost) options_.on_lost(why);
}

void LeaderLease::renew() {
  std::unique_ptr<SqlConnection> db;
  core::MutexLock lock(mutex_);
  while (!ends_ && !lost_) {
    const std::string url = url_;
    const TimePoint begun = std::chrono::steady_clock::now();
    if (works_ && !works_()) {
      trouble_ = "this coordinator does nothing any more";
      wake_.wait_until(mutex_, begun + options_.time / kRenewalsPerLease);
      continue;
    }
    lock.unlock();
    core::Status done;
    bool leads = true;
    if (!db) {
      PostgresOptions postgres = leader_connection(options_.database, incarnation_, {});
      postgres.incarnation.reset();  // the statement says it itself
      postgres.patience = options_.time;
      auto opened = open_postgres(postgres);
      if (opened) {
        db = std::move(*opened);
        done = db->run_script("SET synchronous_commit = off");
      } else {
        done = opened.error();
      }
    }
    if (done) {
      const auto renewed = renew_lease(*db, incarnation_, url);
      if (!renewed) done = renewed.error();
      leads = !renewed || *renewed;
    }
    if (!done) db.reset();
    if (!leads) return lose(kOtherLeads);
    lock.lock();
    trouble_ = done ? "" : done.error().message;
    if (done) renewed_ = begun;
    if (!ends_ && !lost_) wake_.wait_until(mutex_, begun + options_.time / kRenewalsPerLease);
  }
}

void LeaderLease::watch() {
  core::MutexLock lock(mutex_);
  while (!ends_ && !lost_) {
    const TimePoint until = end();
    if (std::chrono::steady_clock::now() >= until) {
      const std::string why =
          trouble_.empty() ? "the database does not answer, or this process stood still" : trouble_;
      lock.unlock();
      return lose("the lease has run out: " + why);
    }
    wake_.wait_until(mutex_, until);
  }
}

}  // namespace hyades::coordinator
