#include "tests/worker/process/process_testing.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>
#include <utility>

#include "core/base/assets.h"
#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::worker {
const char* const kYaml = R"(
hyades: 1
film: {size: [96, 64]}
sampling: {samples: 256, seed: 3}
camera: {look_from: [4.2, 3.6, 7.2], look_at: [0, 0, 0], fov: 40}
materials:
  gold: {type: conductor, metal: gold, roughness: 0.3}
objects:
  vase: {mesh: vase.ply, material: gold}
  ground: {shape: rectangle, size: [60, 60], at: [0, -1.7, 0]}
environment: {image: dusk.exr}
)";

namespace {

class MapResolver : public core::AssetResolver {
 public:
  explicit MapResolver(const std::map<std::string, std::string>& files) : files_(files) {}
  core::Result<core::Bytes> open(const std::string& reference, const std::string& from) override {
    const auto found = files_.find(core::resolve_reference(reference, from));
    if (found == files_.end()) return core::Error{reference + ": no such file"};
    return core::Bytes{nullptr, std::as_bytes(std::span(found->second))};
  }

 private:
  const std::map<std::string, std::string>& files_;
};

}  // namespace

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

Made make_job(uint32_t batches_per_unit) {
  Made made;
  made.job.files = {{"job.yaml", kYaml},
                    {"vase.ply", read_file("jobs/quickstart/vase.ply")},
                    {"dusk.exr", read_file("jobs/quickstart/dusk.exr")}};
  MapResolver files(made.job.files);
  core::Diagnostics diagnostics;
  const core::Job job = core::parse_job(kYaml, "job.yaml", files, diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string();
  core::SceneCache cache(files);
  const auto scene = core::build_scene(job, 1, cache);
  EXPECT_TRUE(scene.ok());
  const core::FrameRenderer renderer(*scene, job, 1, core::needed_layers(job));
  const core::PixelRect window = core::render_window(job.film);
  core::RenderFrameOptions options;
  options.threads = 2;
  made.digest =
      core::render_frame(renderer, window, job.sampling.samples, 1, options).film.digest();
  made.job.film = core::Film(renderer.layout(), window);
  const uint32_t batches = core::batch_count(job.sampling.samples);
  for (uint32_t first = 0; first < batches; first += batches_per_unit) {
    for (int y = window.y0; y < window.y1; y += 16) {
      for (int x = window.x0; x < window.x1; x += 16) {
        made.job.units.push_back({1,
                                  intersection(window, {x, y, x + 16, y + 16}),
                                  {first, std::min(batches_per_unit, batches - first)}});
      }
    }
  }
  return made;
}

WorkerProcess::WorkerProcess(const std::string& address, const std::string& folder,
                             std::vector<std::string> more) {
  static int count = 0;
  log_ = folder + "/worker." + std::to_string(++count) + ".log";
  std::vector<std::string> words = {HYADES_WORKER,     "--coordinator", address, "--cache",
                                    folder + "/cache", "--threads",     "2"};
  words.insert(words.end(), more.begin(), more.end());
  pid_ = ::fork();
  if (pid_ != 0) return;
  const int log = ::open(log_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
  ::dup2(log, 2);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

WorkerProcess::~WorkerProcess() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void WorkerProcess::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);  // else it has ended, and 0 would be all of this test's group
}

std::optional<int> WorkerProcess::wait(std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = 0;
      return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

pid_t WorkerProcess::renderer() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) +
                     "/children");
  pid_t child = 0;
  file >> child;
  return child;
}

void expect_whole(const FakeCoordinator& coordinator, const Made& made) {
  EXPECT_EQ(coordinator.film_digest(), made.digest);
  for (const std::string& damage : coordinator.seen().damage) ADD_FAILURE() << damage;
}

}  // namespace hyades::worker
