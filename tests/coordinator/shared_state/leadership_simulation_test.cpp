// Three coordinators and a database in simulated time: they are killed, frozen and cut off, answers
// get lost after commits, and the database fails over. What decides is the real code (LeaderWatch,
// the statements of lease_rows.h); the fence is that of coordinator/sql/postgres.cpp, whose locks
// the tests of that room try on a real server.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/shared_state/leader_watch.h"
#include "coordinator/shared_state/lease_rows.h"
#include "coordinator/sql/sqlite.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;
using TimePoint = LeaderWatch::TimePoint;

constexpr milliseconds kLease = 3000ms;
constexpr int kCoordinators = 3;
constexpr int kBatches = 100;
constexpr milliseconds kFaultsFor = 60s;

/// A connection to the simulated database that may be cut at any statement. `incarnation`: as
/// PostgresOptions::incarnation.
class SimulatedConnection final : public SqlConnection {
 public:
  SimulatedConnection(SqlConnection& db, std::mt19937& random, double losses,
                      std::optional<uint64_t> incarnation)
      : db_(db), random_(random), losses_(losses), incarnation_(incarnation) {}

  std::unique_ptr<SqlStatement> prepare(std::string_view sql, std::string& error) override {
    if (lost()) {
      error = "the connection is lost";
      return nullptr;
    }
    return db_.prepare(sql, error);
  }
  core::Status run_script(const std::string& sql) override { return db_.run_script(sql); }
  core::Status begin(Durability durability) override {
    if (lost()) return core::Error{"the connection is lost"};
    if (core::Status begun = db_.begin(durability); !begun || !incarnation_) return begun;
    Query leads(db_, "SELECT 1 FROM leader WHERE incarnation = ?");
    if (leads.bind(number(*incarnation_)).next()) return {};
    fenced = true;
    db_.roll_back();
    return core::Error{"another coordinator leads now"};
  }
  core::Status commit() override {
    if (lost()) return core::Error{"the connection is lost"};
    if (core::Status done = db_.commit(); !done) return done;
    // The answer is lost: it is done, and nobody knows.
    if (lost()) return committed = true, core::Error{"the connection is lost"};
    return committed = true, core::Status();
  }
  void roll_back() override {
    if (!committed) db_.roll_back();
  }

  bool fenced = false;
  bool committed = false;

 private:
  bool lost() { return std::bernoulli_distribution(losses_)(random_); }

  SqlConnection& db_;
  std::mt19937& random_;
  const double losses_;
  const std::optional<uint64_t> incarnation_;
};

std::unique_ptr<SqliteConnection> open_in_memory() {
  sqlite3* db = nullptr;
  EXPECT_EQ(sqlite3_open(":memory:", &db), SQLITE_OK);
  return std::make_unique<SqliteConnection>(std::unique_ptr<sqlite3, CloseSqlite>(db));
}

/// A coordinator: what it knows, and when it does something next.
struct Actor {
  std::string name;
  TimePoint next;
  TimePoint cut_until{};  ///< from the database
  LeaderWatch watch{};
  uint64_t incarnation = 0;  ///< 0: it stands by
  TimePoint renewed{};
  TimePoint renew_at{};
  std::set<int> open{};  ///< batches that it has not, as it knows
};

class World {
 public:
  explicit World(uint32_t seed, bool with_fence = true) : random_(seed), with_fence_(with_fence) {
    must(db_->run_script(
        "CREATE TABLE leader (incarnation INTEGER); INSERT INTO leader VALUES (0);"
        "CREATE TABLE lease (incarnation INTEGER, renewed INTEGER, holder TEXT, url TEXT, lease_ms "
        "INTEGER); INSERT INTO lease VALUES (0, 0, '', '', 0);"
        "CREATE TABLE batches (number INTEGER PRIMARY KEY AUTOINCREMENT, batch INTEGER, "
        "incarnation INTEGER)"));
    for (int i = 0; i < kCoordinators; ++i) {
      actors_.push_back({"host:" + std::to_string(i), TimePoint{} + milliseconds(between(0, 500))});
    }
  }

  void run() {
    TimePoint now;
    while (now < end() && !is_done()) {
      auto next = std::min_element(actors_.begin(), actors_.end(),
                                   [](const Actor& a, const Actor& b) { return a.next < b.next; });
      now = next->next;
      step(*next, now);
    }
    done_at = now;
  }

  /// What must hold of what the database holds in the end; empty where it does.
  std::string broken() {
    std::map<int, int> counted;
    uint64_t last = 0;
    std::set<int> stored;
    Query rows(*db_, "SELECT batch, incarnation FROM batches ORDER BY number");
    while (rows.next()) {
      const int batch = static_cast<int>(rows.integer(0));
      if (++counted[batch] > 1) return "batch " + std::to_string(batch) + " counts twice";
      const auto incarnation = static_cast<uint64_t>(rows.integer(1));
      if (incarnation < last) {
        return "incarnation " + std::to_string(incarnation) + " has written after " +
               std::to_string(last);
      }
      last = incarnation;
      stored.insert(batch);
    }
    for (const int batch : acknowledged_) {
      if (!stored.contains(batch)) return "batch " + std::to_string(batch) + " is lost";
    }
    if (!is_done()) return "not all batches are done";
    return {};
  }

  TimePoint done_at;
  int takeovers = 0;
  int fenced = 0;

 private:
  static void must(const core::Status& done) { ASSERT_TRUE(done.ok()); }
  static TimePoint end() { return TimePoint{} + kFaultsFor + 120s; }
  bool calm(TimePoint now) const { return now >= TimePoint{} + kFaultsFor; }
  bool is_done() const { return acknowledged_.size() == kBatches; }
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  bool chance(double probability) { return std::bernoulli_distribution(probability)(random_); }

  SimulatedConnection connect(const Actor& actor, TimePoint now) {
    const bool cut = now < actor.cut_until || now < down_until_;
    const double losses = cut ? 1.0 : calm(now) ? 0.0 : 0.02;
    const bool fence = actor.incarnation > 0 && with_fence_;
    return {*db_, random_, losses, fence ? std::optional(actor.incarnation) : std::nullopt};
  }

  void step(Actor& actor, TimePoint now) {
    const bool was_leader = actor.incarnation > 0;
    if (was_leader) {
      lead(actor, now);
    } else {
      stand_by(actor, now);
    }
    if (!calm(now)) hurt(actor, now);
  }

  /// Beginning anew takes some time; nothing is known afterwards.
  static void begin_anew(Actor& actor, TimePoint now, milliseconds pause) {
    actor.incarnation = 0;
    actor.watch = {};
    actor.open.clear();
    actor.next = now + pause;
  }

  void stand_by(Actor& actor, TimePoint now) {
    actor.next = now + milliseconds(between(200, 400));
    auto db = connect(actor, now);
    const auto row = read_lease(db);
    if (!row || !actor.watch.is_gone(*row, now)) return;
    const auto led = take_over(db, *row, actor.name, kLease);
    if (!led || !*led) return;
    ++takeovers;
    actor.incarnation = **led;
    actor.renewed = now;
    actor.renew_at = now;
    recover(actor, now);
  }

  /// What the store holds is all that a leader knows.
  void recover(Actor& actor, TimePoint now) {
    actor.next = now + milliseconds(between(10, 300));
    for (int batch = 0; batch < kBatches; ++batch) actor.open.insert(batch);
    Query rows(*db_, "SELECT batch FROM batches");
    while (rows.next()) actor.open.erase(static_cast<int>(rows.integer(0)));
    // Workers that had no acknowledgement deliver again, and are told that it is there.
    for (int batch = 0; batch < kBatches; ++batch) {
      if (!actor.open.contains(batch)) acknowledged_.insert(batch);
    }
  }

  void lead(Actor& actor, TimePoint now) {
    actor.next = now + milliseconds(between(50, 900));
    // What was on its way when the process was frozen goes out before it looks at any clock.
    if (!actor.open.empty() && chance(0.7)) store_batch(actor, now);
    if (actor.incarnation == 0) return;
    if (now - actor.renewed >= kLease * 4 / 5) return begin_anew(actor, now, 300ms);
    if (now < actor.renew_at) return;
    auto db = connect(actor, now);
    const auto renewed = renew_lease(db, actor.incarnation, "");
    actor.renew_at = now + kLease / 6;
    if (renewed && *renewed) actor.renewed = now;
    if (renewed && !*renewed) begin_anew(actor, now, 300ms);
  }

  void store_batch(Actor& actor, TimePoint now) {
    const int batch =
        *std::next(actor.open.begin(), between(0, static_cast<int>(actor.open.size()) - 1));
    auto db = connect(actor, now);
    core::Status done;
    {
      Transaction transaction(db);
      done = transaction.status();
      if (done) {
        done = Query(db, "INSERT INTO batches (batch, incarnation) VALUES (?, ?)")
                   .bind(int64_t{batch})
                   .bind(number(actor.incarnation))
                   .run();
      }
      if (done) done = transaction.commit();
    }
    if (db.fenced) ++fenced;
    if (!done) return begin_anew(actor, now, 300ms);
    actor.open.erase(batch);
    acknowledged_.insert(batch);
  }

  void hurt(Actor& actor, TimePoint now) {
    if (chance(0.02)) begin_anew(actor, now, milliseconds(between(100, 5000)));  // killed
    if (chance(0.02)) actor.next = now + milliseconds(between(1000, 12000));     // frozen
    if (chance(0.01)) actor.cut_until = now + milliseconds(between(500, 8000));
    if (chance(0.002)) {
      // The database fails over; renewals are not durable.
      down_until_ = now + milliseconds(between(500, 6000));
      must(Query(*db_, "UPDATE lease SET renewed = MAX(renewed - 3, 0)").run());
    }
  }

  std::mt19937 random_;
  const bool with_fence_;
  const std::unique_ptr<SqliteConnection> db_ = open_in_memory();
  std::vector<Actor> actors_;
  std::set<int> acknowledged_;
  TimePoint down_until_;
};

TEST(LeadershipSimulation, OneLeadsAtATimeAndNothingIsLostOrCountedTwice) {
  int takeovers = 0;
  int fenced = 0;
  for (uint32_t seed = 0; seed < 2000; ++seed) {
    World world(seed);
    world.run();
    ASSERT_EQ(world.broken(), "") << "seed " << seed;
    takeovers += world.takeovers;
    fenced += world.fenced;
  }
  // What is to be survived has happened.
  EXPECT_GT(takeovers, 10'000);
  EXPECT_GT(fenced, 500);
}

TEST(LeadershipSimulation, WithoutTheFenceItWouldBeNoticed) {
  int broken = 0;
  for (uint32_t seed = 0; seed < 100; ++seed) {
    World world(seed, false);
    world.run();
    broken += world.broken().empty() ? 0 : 1;
  }
  EXPECT_GT(broken, 10);
}

}  // namespace
}  // namespace hyades::coordinator
