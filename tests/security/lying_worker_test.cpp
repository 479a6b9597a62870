// What a worker with a good token can do to the pixels of a farm, and to other workers.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/controller/lease_proof.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

core::Unit unit_at(int32_t x, uint32_t first, uint32_t count) {
  return {3, {x, 0, x + 16, 16}, {first, count}};
}

TEST(LeaseProofs, AreOfOneWorkerAndUnitAndItsParts) {
  const LeaseProofs proofs("secret");
  const JobId job{7};
  const std::string proof = proofs.make("worker-of-ada-0001", job, unit_at(0, 4, 8));
  EXPECT_TRUE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 8)));
  EXPECT_TRUE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 1))) << "its beginning";
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0002", job, unit_at(0, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", JobId{8}, unit_at(0, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(16, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 0, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 9)));
  EXPECT_FALSE(LeaseProofs("other").holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 8)));
  for (size_t i = 0; i < proof.size(); ++i) {
    std::string changed = proof;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(proofs.holds(changed, "worker-of-ada-0001", job, unit_at(0, 4, 8))) << i;
  }
  EXPECT_FALSE(proofs.holds("", "worker-of-ada-0001", job, unit_at(0, 4, 8)));
}

/// A worker that takes nothing and delivers what it likes.
ScriptedWorker::Script idle_script(const FarmWorld& world, int number) {
  ScriptedWorker::Script script = world.script(number);
  script.meddle = [](ScriptedWorker&, const v1::LeasedUnit&) { return false; };
  return script;
}

TEST(LyingWorker, FilmsOfUnitsThatItWasNotLeasedDoNotCount) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::optional<v1::LeasedUnit> honest;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    if (!honest) honest = unit;
    return false;
  };
  const ScriptedWorker ada(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return honest.has_value();
  }));
  ScriptedWorker liar(world.address, idle_script(world, 2));
  ASSERT_TRUE(eventually([&] { return liar.streams() > 0; }));
  v1::LeasedUnit stolen = *honest;  // with ada's lease, and ada's proof
  liar.deliver(stolen);
  stolen.mutable_unit()->clear_proof();
  liar.deliver(stolen);
  stolen.mutable_lease()->set_number(999'999);
  liar.deliver(stolen);
  ASSERT_TRUE(eventually([&] { return liar.rejections().size() == 3; }));
  for (const v1::Rejected& rejected : liar.rejections()) {
    EXPECT_EQ(rejected.reason(), v1::Rejected::REASON_UNKNOWN);
    EXPECT_EQ(rejected.text(), "the unit was not leased to this worker");
  }
  EXPECT_EQ(world.get(job).job().samples_done(), 0U);
}

std::string document_with_ids() {
  std::string document = FarmWorld::document(1);
  document.resize(document.find("outputs:"));
  return document + "outputs: [{file: balls.####.exr, layers: [beauty, crypto_object]}]\n";
}

ScriptedWorker::Script script_with_ids(const FarmWorld& world) {
  core::LayerSet layers;
  layers.ids = {true, false};
  ScriptedWorker::Script script = world.script(1);
  script.layout = core::make_film_layout(layers);
  return script;
}

TEST(LyingWorker, FillsNoMemoryByNamesThatNoPixelHas) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(document_with_ids());
  ScriptedWorker::Script script = script_with_ids(world);
  script.corrupt = [](core::Film& film) {
    for (uint32_t id = 1; id <= 120'000; ++id) film.mutable_ids(core::IdKind::object).name(id, "");
  };
  const ScriptedWorker liar(world.address, script);
  ASSERT_TRUE(eventually([&] { return liar.rejections().size() > 2; }));
  for (const v1::Rejected& rejected : liar.rejections()) {
    EXPECT_EQ(rejected.reason(), v1::Rejected::REASON_DAMAGED);
    EXPECT_NE(rejected.text().find("no pixel holds"), std::string::npos) << rejected.text();
  }
  EXPECT_EQ(world.get(job).job().samples_done(), 0U);
}

TEST(LyingWorker, FramesFailWhoseIdsOutgrowTheirRoom) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(document_with_ids());
  ScriptedWorker::Script script = script_with_ids(world);
  // Every sample meets an object of its own, as those of a crowd out of focus may.
  script.corrupt = [](core::Film& film) {
    core::IdLayer& ids = film.mutable_ids(core::IdKind::object);
    const uint32_t before = 16 * film.coverage().boxes().front().batches.first;
    const auto width = static_cast<uint32_t>(film.window().width());
    std::vector<core::IdCount> counts;
    for (uint32_t i = 0; i < film.window().area(); ++i) {
      const int x = film.window().x0 + static_cast<int>(i % width);
      const int y = film.window().y0 + static_cast<int>(i / width);
      const auto samples = static_cast<uint32_t>(film.sum(x, y, film.layout().samples).high);
      for (uint32_t s = 0; s < samples; ++s) {
        const uint32_t id = 1 + static_cast<uint32_t>(y * 80 + x) * 64 + before + s;
        counts.push_back({i, id, 1});
        ids.name(id, "one of a crowd");
      }
    }
    ids.deposit(std::move(counts));
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_FAILED));
  const v1::GetJobResponse told = world.get(job);
  ASSERT_EQ(told.frames_size(), 1);
  EXPECT_NE(told.frames(0).reason().find("crypto_object"), std::string::npos)
      << told.frames(0).reason();
}

TEST(LyingWorker, AddsNoSumsThatLeaveNoRoomForOthers) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  ScriptedWorker::Script script = world.script(1);
  script.corrupt = [](core::Film& film) {
    film.mutable_plane(film.layout().moment2)[0] = core::Fixed128{0, INT64_MAX};
  };
  const ScriptedWorker liar(world.address, script);
  ASSERT_TRUE(eventually([&] { return liar.rejections().size() > 2; }));
  EXPECT_NE(liar.rejections().front().text().find("beyond what"), std::string::npos)
      << liar.rejections().front().text();
  EXPECT_EQ(world.get(job).job().samples_done(), 0U);
}

// A coverage of pieces takes a hundred times its bytes before anybody looks at it.
TEST(LyingWorker, FillsNoMemoryByPiecesOfAFilm) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  ScriptedWorker::Script script = world.script(1);
  script.corrupt = [](core::Film& film) {
    const core::CoverageBox whole = film.coverage().boxes().front();
    core::Coverage pieces;
    for (int32_t y = whole.tile.y0; y < whole.tile.y1; ++y) {
      for (int32_t x = whole.tile.x0 + y % 2; x < whole.tile.x1; x += 2) {
        pieces.add({{x, y, x + 1, y + 1}, whole.batches});
      }
    }
    film.mutable_coverage() = pieces;
  };
  const ScriptedWorker liar(world.address, script);
  ASSERT_TRUE(eventually([&] { return liar.rejections().size() > 2; }));
  EXPECT_NE(liar.rejections().front().text().find("boxes"), std::string::npos)
      << liar.rejections().front().text();
  EXPECT_EQ(world.get(job).job().samples_done(), 0U);
}

TEST(LyingWorker, WhoSendsFilmAfterFilmThatIsNoneIsCutOff) {
  FarmWorld world;
  world.start();
  world.submit(1);
  ScriptedWorker::Script script = world.script(1);
  script.corrupt = [](core::Film& film) {
    film.mutable_plane(film.layout().moment2)[0] = core::Fixed128{0, INT64_MAX};
  };
  const ScriptedWorker liar(world.address, script);
  EXPECT_TRUE(eventually([&] { return liar.rejections().size() >= 20 && liar.streams() > 1; }))
      << liar.rejections().size();
}

TEST(LyingWorker, WritesIntoNoLogByFilmsOfUnitsThatItHasNoMore) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  const auto lines_of = [&](const std::string& text) {
    v1::LogsRequest request;
    request.set_job(job);
    const auto context = world.context();
    const auto reader = world.jobs->Logs(context.get(), request);
    int found = 0;
    v1::LogLine line;
    while (reader->Read(&line)) found += line.text() == text ? 1 : 0;
    (void)reader->Finish();
    return found;
  };
  {
    std::atomic<bool> begun{false};
    ScriptedWorker::Script script = world.script(1);
    script.note = "spam";
    script.meddle = [&](ScriptedWorker& liar, const v1::LeasedUnit& unit) {
      if (begun.exchange(true)) return false;
      v1::WorkerMessage back;
      *back.mutable_returned()->add_units() = unit;
      liar.write(back);
      for (int i = 0; i < 20; ++i) liar.deliver(unit);
      return false;
    };
    const ScriptedWorker liar(world.address, script);
    ASSERT_TRUE(eventually([&] { return liar.delivered() == 20; }));
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(lines_of("spam"), 0);
  }
  ScriptedWorker::Script script = world.script(2);
  script.note = "a sample was no number";
  const ScriptedWorker honest(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_GT(lines_of("a sample was no number"), 0);
}

TEST(LyingWorker, GivesNoUnitsOfOthersBackAndBlamesNoneOfThem) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::vector<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    held.push_back(unit);
    return false;
  };
  const ScriptedWorker ada(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !held.empty();
  }));
  const auto out = [&] { return world.get(job).job().leased(); };
  const auto before = out();
  ASSERT_GT(before, 0U);
  ScriptedWorker::Script idle = idle_script(world, 2);
  idle.threads = 1;
  ScriptedWorker liar(world.address, idle);
  ASSERT_TRUE(eventually([&] { return out() > before; }));  // it has some of its own
  const auto all = out();
  {
    const std::lock_guard lock(mutex);
    v1::WorkerMessage message;
    for (const v1::LeasedUnit& unit : held) *message.mutable_returned()->add_units() = unit;
    liar.write(message);
    for (const v1::LeasedUnit& unit : held) liar.fail(unit, "it is evil");
  }
  std::this_thread::sleep_for(200ms);
  EXPECT_GE(out(), all);
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_RUNNING);
}

TEST(LyingWorker, WritesIntoTheLogOfNoJobThatItHasNoUnitOf) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  const uint64_t other = world.submit(1);
  std::mutex mutex;
  std::vector<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    if (unit.job() == job) held.push_back(unit);
    return false;
  };
  ScriptedWorker liar(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !held.empty();
  }));
  v1::LeasedUnit unit = held.front();
  unit.set_job(other);
  for (int i = 0; i < 20; ++i) liar.fail(unit, "invented");
  v1::WorkerMessage message;
  message.mutable_returned()->set_reason("invented");
  *message.mutable_returned()->add_units() = unit;
  liar.write(message);
  unit.set_job(job);
  liar.fail(unit, "told");
  const auto says = [&](uint64_t of, const std::string& text) {
    v1::LogsRequest request;
    request.set_job(of);
    const auto context = world.context();
    const auto reader = world.jobs->Logs(context.get(), request);
    bool found = false;
    v1::LogLine line;
    while (reader->Read(&line)) found |= line.text().find(text) != std::string::npos;
    (void)reader->Finish();
    return found;
  };
  EXPECT_TRUE(eventually([&] { return says(job, "told"); }));
  EXPECT_FALSE(says(other, "invented"));
}

TEST(LyingWorker, ALeaseThatItNamesManyTimesIsTakenBackOnce) {
  FarmWorld world;
  world.options.lease_time = 10s;
  world.options.stall_time = 1s;
  world.options.copy_after = 1h;
  world.start();
  world.submit(1);
  std::mutex mutex;
  std::vector<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    held.push_back(unit);
    return false;
  };
  ScriptedWorker liar(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !held.empty();
  }));
  std::this_thread::sleep_for(200ms);
  v1::WorkerMessage beat;
  {
    const std::lock_guard lock(mutex);
    for (int i = 0; i < 200; ++i) {
      for (const v1::LeasedUnit& unit : held) {
        v1::LeaseProgress& told = *beat.mutable_heartbeat()->add_leases();
        *told.mutable_lease() = unit.lease();
        told.set_stage(v1::LeaseProgress::STAGE_RENDERING);
      }
    }
  }
  const size_t units = held.size();
  ASSERT_TRUE(eventually([&] {
    liar.write(beat);
    std::this_thread::sleep_for(100ms);
    return liar.stopped() > 0;
  }));
  std::this_thread::sleep_for(500ms);
  EXPECT_LE(liar.stopped(), units);
}

TEST(LyingWorker, WhatItSaysToHaveFromBeforeARestartItHasToProve) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::optional<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.hold = true;
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    held = unit;
    return true;
  };
  std::optional<ScriptedWorker> honest;
  honest.emplace(world.address, script);
  ASSERT_TRUE(eventually([&] { return honest->unacknowledged() > 0; }));
  world.stop();
  honest.reset();
  world.start();
  ScriptedWorker::Script forger = idle_script(world, 2);
  forger.claims = {*held};
  const ScriptedWorker liar(world.address, forger);
  ASSERT_TRUE(eventually([&] { return liar.stopped() > 0; }));
  EXPECT_EQ(liar.adopted(), 0U);
  ScriptedWorker::Script again = world.script(1);
  again.claims = {*held};
  const ScriptedWorker owner(world.address, again);
  EXPECT_TRUE(eventually([&] { return owner.adopted() > 0; })) << "who has a proof keeps his own";
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_RUNNING);
}

/// A farm with tokens, of which one is of many workers.
class WorkersWithTokens : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    world.token = make("root", v1::ROLE_ADMIN);
    joins = make("nodes", v1::ROLE_WORKER);
  }
  std::string make(const std::string& name, v1::Role role, const std::string& pool = {}) {
    std::string text;
    StoredToken row;
    v1::CreateTokenRequest asked;
    asked.set_name(name);
    asked.set_role(role);
    asked.set_pool(pool);
    const grpc::Status made = world.authority->create(asked, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    return text;
  }
  /// Of a worker that takes nothing.
  ScriptedWorker::Script script(int number, const std::string& token, bool keeps_token) const {
    ScriptedWorker::Script script = idle_script(world, number);
    script.token = token;
    script.keeps_token = keeps_token;
    script.reconnect = false;
    return script;
  }
  ScriptedWorker::Script liar(int number, const std::string& token, bool keeps_token) const {
    ScriptedWorker::Script lies = script(number, token, keeps_token);
    lies.corrupt = [](core::Film& film) { film.mutable_plane(0)[0] += core::Fixed128{0, 1}; };
    return lies;
  }
  /// Honest: it delivers one unit, which is returned.
  v1::LeasedUnit begin(std::optional<ScriptedWorker>& honest) {
    world.submit(1);
    ScriptedWorker::Script delivers = script(1, joins, true);
    delivers.meddle = [this](ScriptedWorker&, const v1::LeasedUnit& leased) {
      const std::lock_guard lock(mutex);
      if (first) return false;
      first = leased;
      return true;
    };
    honest.emplace(world.address, delivers);
    EXPECT_TRUE(eventually([&] { return honest->acknowledged() > 0; }));
    const std::lock_guard lock(mutex);
    return *first;
  }
  bool quarantined(const std::string& name) const {
    v1::WorkersResponse all;
    EXPECT_TRUE(world.farm_->Workers(world.context().get(), {}, &all).ok());
    for (const v1::Worker& worker : all.workers()) {
      if (worker.name() == name) return worker.state() == v1::WORKER_STATE_QUARANTINED;
    }
    return false;
  }
  /// They say of the unit what they say, one after the other.
  void say(const std::vector<ScriptedWorker*>& workers, const v1::LeasedUnit& unit) {
    for (ScriptedWorker* worker : workers) {
      ASSERT_TRUE(eventually([&] { return worker->streams() > 0; }));
      worker->deliver(world.leased_to(*worker, unit));
      ASSERT_TRUE(
          eventually([&] { return worker->acknowledged() > 0 || !worker->rejections().empty(); }));
    }
  }

  FarmWorld world;
  std::string joins;
  std::mutex mutex;
  std::optional<v1::LeasedUnit> first;
};

TEST_F(WorkersWithTokens, InventedOnesUnderOneTokenAreOneWitness) {
  std::optional<ScriptedWorker> honest;
  const v1::LeasedUnit unit = begin(honest);
  ScriptedWorker a(world.address, liar(2, joins, false));
  ScriptedWorker b(world.address, liar(3, joins, false));
  ScriptedWorker c(world.address, liar(4, joins, false));
  say({&a, &b, &c}, unit);
  EXPECT_FALSE(quarantined("scripted/1"));
  // Two machines that have joined are two, and the liars are found out.
  ScriptedWorker d(world.address, script(5, joins, true));
  say({&d}, unit);
  EXPECT_TRUE(eventually([&] { return quarantined("scripted/2"); }));
  EXPECT_FALSE(quarantined("scripted/1"));
}

TEST_F(WorkersWithTokens, OnesOfAPoolAreOneWitness) {
  const std::string cloud = make("cloud", v1::ROLE_WORKER, "cloud");
  const std::string more = make("more", v1::ROLE_WORKER, "cloud");
  std::optional<ScriptedWorker> honest;
  const v1::LeasedUnit unit = begin(honest);
  ScriptedWorker a(world.address, liar(2, cloud, true));
  ScriptedWorker b(world.address, liar(3, more, true));
  say({&a, &b}, unit);
  EXPECT_FALSE(quarantined("scripted/1"));
}

TEST_F(WorkersWithTokens, ATokenOfAMachineIsItsWorkersAlone) {
  std::string own;
  {
    const ScriptedWorker joining(world.address, script(1, joins, true));
    ASSERT_TRUE(eventually([&] { return !joining.welcome().machine_token().empty(); }));
    own = joining.welcome().machine_token();
  }
  const ScriptedWorker other(world.address, script(2, own, true));
  ASSERT_TRUE(eventually(
      [&] { return other.last_status().error_code() == grpc::StatusCode::PERMISSION_DENIED; }));
  EXPECT_EQ(other.last_status().error_message(), "this token is another worker's");
  ScriptedWorker::Script comes_back = script(1, own, true);
  comes_back.reconnect = true;  // the coordinator may not have noticed yet that it went
  const ScriptedWorker same(world.address, comes_back);
  ASSERT_TRUE(eventually([&] { return same.welcome().incarnation() > 0; }));
  EXPECT_EQ(same.welcome().machine_token(), "") << "it has one";
}

}  // namespace
}  // namespace hyades::coordinator
