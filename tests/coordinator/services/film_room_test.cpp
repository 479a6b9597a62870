// Films of all jobs together have so much memory.
#include <gmock/gmock.h>

#include <atomic>

#include "core/film/layout.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

TEST(FilmRoom, AJobSaysThatItWaitsForMemoryForItsFilm) {
  FarmWorld world;
  const uint64_t film =
      core::film_memory(core::make_film_layout({}), {0, 0, FarmWorld::kWidth, FarmWorld::kHeight});
  world.options.film_memory = film + film / 2;
  world.start();
  const uint64_t first = world.submit(1);
  const uint64_t second = world.submit(1);
  // Nothing of the first job is delivered before the second has said why it waits.
  std::atomic<bool> go{false};
  ScriptedWorker::Script script = world.script();
  script.threads = 8;
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit&) {
    return eventually([&] { return go.load(); });
  };
  ScriptedWorker worker(world.address, script);
  EXPECT_TRUE(eventually([&] {
    return world.explain(second).find("waits for memory for its film") != std::string::npos;
  })) << world.explain(second);
  EXPECT_EQ(world.explain(first).find("memory"), std::string::npos);
  EXPECT_EQ(world.get(second).job().leased(), 0U);
  go = true;
  EXPECT_TRUE(world.wait_for(first, v1::JOB_STATE_DONE));
  EXPECT_TRUE(world.wait_for(second, v1::JOB_STATE_DONE));
  world.expect_truth(second, 1);
}

}  // namespace
}  // namespace hyades::coordinator
