// `hyades render --display` with the real program: what the viewer shows in the end is what the
// film that was written holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <fstream>

#include "core/film/film_exr.h"
#include "tests/support/fake_viewer.h"
#include "tests/support/temp_folder.h"

extern char** environ;

namespace hyades::cli {
namespace {

/// Runs `hyades-render render` with these arguments and returns its exit status.
int render(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {HYADES_RENDER, "render"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t pid = 0;
  if (posix_spawn(&pid, HYADES_RENDER, nullptr, nullptr, argv.data(), environ) != 0) return -1;
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string write_job(const test::TempFolder& folder, const std::string& integrator) {
  const std::string path = folder.file("ball.yaml");
  std::ofstream(path) << R"(hyades: 1
name: ball
frames: {range: 2-3}
film: {size: [100, 70]}
sampling: {samples: 16}
integrator: {type: )" << integrator
                      << R"(}
objects:
  ball: {shape: sphere, radius: 1}
  lamp: {shape: sphere, radius: 0.3, at: [2, 2, 2], emit: {color: 1, power: 60}}
environment: {color: 0.3}
outputs: [{file: ball.####.exr, layers: [beauty, albedo, normal, depth]}]
)";
  return path;
}

/// The viewer shows the films of both frames that were written into `folder`.
void expect_films(const test::FakeViewer& fake, const test::TempFolder& folder) {
  for (const std::string frame : {"ball.0002", "ball.0003"}) {
    SCOPED_TRACE(frame);
    const auto film = core::read_film_exr(folder.file("out/" + frame + ".film.exr"));
    ASSERT_TRUE(film) << film.error().message;
    const core::Image truth = film->film.normalised();
    EXPECT_TRUE(fake.wait_until([&](const auto& seen) { return seen.pictures.contains(frame); }));
    const auto seen = fake.seen();
    ASSERT_TRUE(seen.pictures.contains(frame));
    const test::FakeViewer::Picture& shown = seen.pictures.at(frame);
    EXPECT_EQ(shown.width, truth.width);
    EXPECT_EQ(shown.height, truth.height);
    EXPECT_EQ(shown.channels, truth.channels);
    EXPECT_TRUE(shown.values == truth.data) << "other pixels";
    EXPECT_THAT(shown.channels, testing::IsSupersetOf({"R", "albedo.G", "normal.Z", "depth.Z"}));
  }
  EXPECT_THAT(fake.seen().wrong, testing::IsEmpty());
}

TEST(RenderDisplay, TheViewerShowsTheFilms) {
  for (const char* integrator : {"path", "bdpt"}) {
    SCOPED_TRACE(integrator);
    const test::TempFolder folder;
    test::FakeViewer fake;
    ASSERT_EQ(render({write_job(folder, integrator), "--output", folder.file("out"), "--film",
                      "--quiet", "--threads", "2", "--display", fake.address()}),
              0);
    expect_films(fake, folder);
    // Both frames may be in work at a time: which is first seen is not said.
    EXPECT_THAT(fake.seen().created, testing::UnorderedElementsAre("ball.0002", "ball.0003"));
  }
}

TEST(RenderDisplay, ACropIsShownByItself) {
  const test::TempFolder folder;
  test::FakeViewer fake;
  ASSERT_EQ(render({write_job(folder, "path"), "--output", folder.file("out"), "--film", "--quiet",
                    "--crop", "30,10,97,33", "--display", fake.address()}),
            0);
  expect_films(fake, folder);
}

TEST(RenderDisplay, NoViewerIsNoFailure) {
  const test::TempFolder folder;
  EXPECT_EQ(
      render({write_job(folder, "path"), "--output", folder.file("out"), "--quiet", "--frames", "2",
              "--display", "127.0.0.1:" + std::to_string(test::free_port())}),
      0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/ball.0002.exr")));
}

TEST(RenderDisplay, AnAddressThatIsNoneIsAWrongArgument) {
  const test::TempFolder folder;
  EXPECT_EQ(render({write_job(folder, "path"), "--display", "14158"}), 2);
}

}  // namespace
}  // namespace hyades::cli
