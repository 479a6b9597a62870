#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/result.h"
#include "worker/pipe/message_pipe.h"
#include "worker/pipe/render_pipe.pb.h"

namespace hyades::worker {

/// How the rendering child is started.
struct RendererOptions {
  std::string program;  ///< path of hyades-worker-render
  std::string cache;    ///< folder of the content store
  int threads = 1;
  uint64_t memory = 0;           ///< bytes; 0: no limit
  std::string sandbox = "auto";  ///< worker/render/sandbox.h
};

/// The child that renders: a process of its own, so that what a scene does to it (a crash, too much
/// memory) is done to nobody else. Thread-safe.
class RendererProcess {
 public:
  /// Called from the process' own threads; must not block.
  class Owner {
   public:
    virtual ~Owner() = default;
    virtual void renderer_says(pipe::FromRenderer message) = 0;
    /// The child is gone and will say no more. `reason` completes "the process ...".
    virtual void renderer_ended(const std::string& reason) = 0;
  };

  static core::Result<std::unique_ptr<RendererProcess>> start(const RendererOptions& options,
                                                              Owner& owner);
  /// Kills the child; the owner hears no more after this.
  ~RendererProcess();
  RendererProcess(const RendererProcess&) = delete;
  RendererProcess& operator=(const RendererProcess&) = delete;

  /// Ends the child; the owner hears of it when it is dead, with this reason.
  void kill(const std::string& reason);

  /// Queues a message; never blocks.
  void send(pipe::ToRenderer message);

 private:
  RendererProcess(pid_t pid, int fd, Owner& owner);
  void read_loop();
  void write_loop();
  void kill_child();

  Owner& owner_;
  pipe::MessagePipe pipe_;
  std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  pid_t pid_;           ///< 0: it has been waited for
  std::string killed_;  ///< why, where this process did it
  std::deque<pipe::ToRenderer> outgoing_;
  bool closing_ = false;

  std::thread reader_;
  std::thread writer_;
};

}  // namespace hyades::worker
