#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "worker/renderer_process.h"
#include "worker/worker_context.h"

namespace hyades::worker {

/// Keeps a rendering child alive: starts one, and another one when it dies, until it is the last.
/// For the loop's thread.
class RendererSupervisor : private RendererProcess::Listener {
 public:
  explicit RendererSupervisor(const WorkerContext& worker) : worker_(worker) {}

  void start();
  /// Starts another child when it is time for it.
  void tick(TimePoint now);
  /// No child is started any more. When this one dies, what it had goes back.
  void last() { last_ = true; }

  /// Whether the child has said what machine it is on, and renders.
  bool ready() const { return ready_; }

  /// Lost where there is no child.
  void tell(pipe::ToRenderer message);
  void kill(const std::string& reason);

 private:
  /// What tells a folder from another of the same name; zeros where there is none.
  using FolderIdentity = std::pair<dev_t, ino_t>;
  static FolderIdentity folder_identity(const std::string& path);

  void renderer_says(pipe::FromRenderer message) override;
  void renderer_ended(const std::string& reason) override;
  void ended(const std::string& reason);
  void tell_sandbox(const pipe::Ready& ready);

  const WorkerContext worker_;
  bool ready_ = false;
  bool last_ = false;
  bool sandbox_told_ = false;
  int early_deaths_ = 0;  ///< in a row, before Ready
  TimePoint started_;
  std::optional<TimePoint> restart_at_;
  FolderIdentity cache_identity_{};           ///< when the child began
  std::unique_ptr<RendererProcess> process_;  ///< last: its threads post
};

}  // namespace hyades::worker
