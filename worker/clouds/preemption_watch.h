#pragma once

#include <memory>
#include <string>
#include <thread>

#include "core/base/mutex.h"
#include "worker/clouds/cloud.h"
#include "worker/clouds/notice.h"

namespace hyades::worker {

class Metadata;

/// Asks a cloud's metadata service, on a thread of its own, whether this machine is to be taken
/// away. Whatever the service does (no answer, a wrong one, none for a long time), it is asked
/// again and nothing else comes of it.
class PreemptionWatch {
 public:
  /// Called from the watch's thread.
  class Listener {
   public:
    virtual ~Listener() = default;
    /// The machine goes; said once, and the watch is over.
    virtual void preempted(const Notice& notice) = 0;
    /// The service does not answer as it should; said once, until the reason changes.
    virtual void watch_trouble(const std::string& reason) = 0;
  };

  /// `endpoint`: another service than the cloud's own, for tests; empty: that one.
  PreemptionWatch(Cloud cloud, const std::string& endpoint, Listener& listener);
  /// Ends what is being asked.
  ~PreemptionWatch();
  PreemptionWatch(const PreemptionWatch&) = delete;
  PreemptionWatch& operator=(const PreemptionWatch&) = delete;

 private:
  void run(Cloud cloud) HYADES_EXCLUDES(mutex_);

  Listener& listener_;
  const std::unique_ptr<Metadata> metadata_;
  core::Mutex mutex_;  ///< with it the thread looks whether it was stopped before it waits
  core::CondVar wake_;
  std::thread thread_;
};

}  // namespace hyades::worker
