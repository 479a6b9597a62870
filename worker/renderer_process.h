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
/// memory) is done to nobody else. It inherits nothing but its pipe, standard error, and of the
/// environment what says how programs run here. One that says what no working child says
/// (RendererTalk) is killed. Thread-safe.
class RendererProcess {
 public:
  /// Called from the process' own threads; must not block.
  class Owner {
   public:
    virtual ~Owner() = default;
    /// To be answered by heard(), when nothing is left of it but what the owner keeps.
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

  /// The owner is done with a message. While it has too many of them, no more are read: a child
  /// that talks without end takes no memory here.
  void heard();

  /// Messages, and bytes of films, that the owner has before it at once (the last may be larger).
  static constexpr size_t kMostUnheard = 1000;
  static constexpr size_t kMostUnheardBytes = size_t{64} << 20U;

  /// Ends the child; the owner hears of it when it is dead, with this reason.
  void kill(const std::string& reason);

  /// Queues a message; never blocks.
  void send(pipe::ToRenderer message);

 private:
  RendererProcess(pid_t pid, int fd, Owner& owner);
  void read_loop();
  void write_loop();
  void kill_child();
  void wait_for_owner(size_t bytes);

  Owner& owner_;
  pipe::MessagePipe pipe_;
  std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  pid_t pid_;           ///< 0: it has been waited for
  std::string killed_;  ///< why, where this process did it
  std::deque<pipe::ToRenderer> outgoing_;
  std::deque<size_t> unheard_;  ///< bytes of the messages that the owner has before it
  size_t unheard_bytes_ = 0;
  bool closing_ = false;

  std::thread reader_;
  std::thread writer_;
};

}  // namespace hyades::worker
