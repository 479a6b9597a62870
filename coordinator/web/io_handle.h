#pragma once

#include <functional>
#include <memory>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Lets other threads hand work to the network's thread, which may end before they do.
/// Thread-safe.
class IoHandle {
 public:
  explicit IoHandle(boost::asio::io_context& network) : network_(&network) {}

  /// Has the network's thread call `what`; after close() nothing happens.
  void post(std::function<void()> what) {
    const core::MutexLock lock(mutex_);
    if (network_ != nullptr) boost::asio::post(*network_, std::move(what));
  }
  /// To be called before the io_context ends.
  void close() {
    const core::MutexLock lock(mutex_);
    network_ = nullptr;
  }

 private:
  core::Mutex mutex_;
  boost::asio::io_context* network_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
