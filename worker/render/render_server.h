#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/base/mutex.h"
#include "core/film/unit.h"
#include "worker/pipe/message_pipe.h"
#include "worker/pipe/render_pipe.pb.h"
#include "worker/render/scene_shelf.h"

namespace hyades::worker {

/// Renders the units that come through a pipe and sends their films back: one unit per thread, the
/// oldest whose scene is loaded first, while one more thread loads the scenes of units that wait.
/// Made for a process of its own: it ends with the process.
class RenderServer {
 public:
  RenderServer(pipe::MessagePipe& parent, SceneShelf& shelf, int threads);

  /// Reads what the parent wants until the pipe ends.
  void run();

 private:
  struct Task {
    enum class State : uint8_t { waiting, loading, ready, rendering };
    uint64_t token = 0;
    uint64_t job = 0;
    core::Unit unit;
    std::shared_ptr<const ShelvedFrame> frame;  ///< from State::ready on
    State state = State::waiting;               ///< with mutex_
    bool keep_batches = false;  ///< with mutex_: when stopped, the batches that are done count
    std::atomic<bool> stop{false};
    std::atomic<uint32_t> batches_done{0};
    std::atomic<uint64_t> samples_done{0};
  };
  using TaskPtr = std::shared_ptr<Task>;

  void add(const pipe::UnitToRender& message) HYADES_EXCLUDES(mutex_);
  void stop(uint64_t token, bool keep_batches) HYADES_EXCLUDES(mutex_);
  void hand_over() HYADES_EXCLUDES(mutex_);
  void render_loop(int thread) HYADES_EXCLUDES(mutex_);
  void load_loop() HYADES_EXCLUDES(mutex_);
  void progress_loop() HYADES_EXCLUDES(mutex_);
  void render(Task& task, int thread) HYADES_EXCLUDES(mutex_);
  TaskPtr take(Task::State from, Task::State to, core::CondVar& wake) HYADES_EXCLUDES(mutex_);
  void send(const pipe::FromRenderer& message, const std::string& film = {});
  void say_failed(uint64_t token, const std::string& reason,
                  const std::set<std::string>& damaged = {});

  pipe::MessagePipe& parent_;
  SceneShelf& shelf_;
  core::Mutex mutex_;
  core::CondVar render_wake_;
  core::CondVar load_wake_;
  std::map<uint64_t, TaskPtr> tasks_ HYADES_GUARDED_BY(mutex_);
  std::vector<std::thread> threads_;
};

}  // namespace hyades::worker
