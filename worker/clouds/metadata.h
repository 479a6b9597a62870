#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hyades::worker {

/// The metadata service of a cloud's machine: plain HTTP to an address of the machine's own link,
/// never by way of a proxy. Used by one thread; another may stop it.
class Metadata {
 public:
  struct Answer {
    long status = 0;
    std::string body;  ///< at most 64 KiB
    std::string etag;
  };
  /// `endpoint`: "http://169.254.169.254", without a slash at the end.
  explicit Metadata(std::string endpoint) : endpoint_(std::move(endpoint)) {}

  /// Asks with GET, or PUT, with headers "Name: value". An error where no answer came in time, it
  /// was too long, or the service was stopped.
  core::Result<Answer> ask(const std::string& path, const std::vector<std::string>& headers,
                           std::chrono::seconds patience = std::chrono::seconds(10),
                           bool put = false) const;

  /// What is being asked ends soon, with an error. From any thread.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

 private:
  const std::string endpoint_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace hyades::worker
