#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

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
    State state = State::waiting;
    std::shared_ptr<const ShelvedFrame> frame;
    bool keep_batches = false;  ///< when stopped, the batches that are done count
    std::atomic<bool> stop{false};
    std::atomic<uint32_t> batches_done{0};
    std::atomic<uint64_t> samples_done{0};
  };
  using TaskPtr = std::shared_ptr<Task>;

  void add(const pipe::UnitToRender& message);
  void stop(uint64_t token, bool keep_batches);
  void render_loop(int thread);
  void load_loop();
  void progress_loop();
  void render(Task& task, int thread);
  TaskPtr next_ready();
  void send(const pipe::FromRenderer& message, const std::string& film = {});
  void say_failed(uint64_t token, const std::string& reason,
                  const std::set<std::string>& damaged = {});

  pipe::MessagePipe& parent_;
  SceneShelf& shelf_;
  std::mutex mutex_;
  std::condition_variable render_wake_;
  std::condition_variable load_wake_;
  std::map<uint64_t, TaskPtr> tasks_;  ///< guarded by mutex_, as are the tasks' plain fields
  std::vector<std::thread> threads_;
};

}  // namespace hyades::worker
