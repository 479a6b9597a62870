#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <thread>

#include "core/base/mutex.h"
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
  uint64_t texture_disk = 0;     ///< bytes
  std::string sandbox = "auto";  ///< worker/render/sandbox.h
};

/// The child that renders: a process of its own, so that what a scene does to it (a crash, too much
/// memory) is done to nobody else. It inherits nothing but its pipe, standard error, and of the
/// environment what says how programs run here. One that says what no working child says
/// (RendererTalk) is killed. Thread-safe.
class RendererProcess {
 public:
  /// Called from the process' own threads; must not block.
  class Listener {
   public:
    virtual ~Listener() = default;
    /// To be answered by heard(), when nothing is left of it but what the listener keeps.
    virtual void renderer_says(pipe::FromRenderer message) = 0;
    /// The child is gone and will say no more. `reason` completes "the process ...".
    virtual void renderer_ended(const std::string& reason) = 0;
  };

  static core::Result<std::unique_ptr<RendererProcess>> start(const RendererOptions& options,
                                                              Listener& listener);
  /// Kills the child; the listener hears no more after this.
  ~RendererProcess();
  RendererProcess(const RendererProcess&) = delete;
  RendererProcess& operator=(const RendererProcess&) = delete;

  /// The listener is done with a message. While it has too many of them, no more are read: a child
  /// that talks without end takes no memory here.
  void heard() HYADES_EXCLUDES(mutex_);

  /// Messages, and bytes of films, that the listener has before it at once (the last may be
  /// larger).
  static constexpr size_t kMostUnheard = 1000;
  static constexpr size_t kMostUnheardBytes = size_t{64} << 20U;

  /// Ends the child; the listener hears of it when it is dead, with this reason.
  void kill(const std::string& reason) HYADES_EXCLUDES(mutex_);

  /// Queues a message; never blocks. A child for which more than kMostUnread waits is killed: it
  /// does not read, and would have this process keep whatever it is told.
  void send(pipe::ToRenderer message) HYADES_EXCLUDES(mutex_);

  /// Bytes; more than what of all jobs may be told at once (StateMachineOptions::max_brief_bytes).
  static constexpr size_t kMostUnread = size_t{256} << 20U;

 private:
  RendererProcess(pid_t pid, int fd, Listener& listener);
  void read_loop() HYADES_EXCLUDES(mutex_);
  void write_loop() HYADES_EXCLUDES(mutex_);
  void kill_child() HYADES_EXCLUDES(mutex_);
  void kill_locked(const std::string& reason) HYADES_REQUIRES(mutex_);
  void wait_for_listener(size_t bytes) HYADES_EXCLUDES(mutex_);

  Listener& listener_;
  pipe::MessagePipe pipe_;
  const pid_t pid_;
  core::Mutex mutex_;
  core::CondVar wake_;
  /// The child has been waited for: its pid may be another process' by now.
  bool reaped_ HYADES_GUARDED_BY(mutex_) = false;
  std::string killed_ HYADES_GUARDED_BY(mutex_);  ///< why, where this process did it
  std::deque<pipe::ToRenderer> outgoing_ HYADES_GUARDED_BY(mutex_);
  size_t outgoing_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  /// Bytes of the messages that the listener has before it.
  std::deque<size_t> unheard_ HYADES_GUARDED_BY(mutex_);
  size_t unheard_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  bool closing_ HYADES_GUARDED_BY(mutex_) = false;

  std::thread reader_;
  std::thread writer_;
};

}  // namespace hyades::worker
