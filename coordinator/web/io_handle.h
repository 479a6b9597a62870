#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

namespace hyades::coordinator {

/// The way from other threads to the network's, which may end before they do.
class IoHandle {
 public:
  explicit IoHandle(boost::asio::io_context& network) : network_(&network) {}

  /// Has the network's thread call `what`; after close() nothing happens.
  void post(std::function<void()> what) {
    const std::lock_guard lock(mutex_);
    if (network_ != nullptr) boost::asio::post(*network_, std::move(what));
  }
  void close() {
    const std::lock_guard lock(mutex_);
    network_ = nullptr;
  }

 private:
  std::mutex mutex_;
  boost::asio::io_context* network_;
};

}  // namespace hyades::coordinator
