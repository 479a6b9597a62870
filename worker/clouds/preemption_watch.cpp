#include "worker/clouds/preemption_watch.h"

#include <chrono>

#include "worker/clouds/metadata.h"
#include "worker/clouds/notice_source.h"

namespace hyades::worker {
namespace {

using Clock = std::chrono::steady_clock;

/// Where all three have it. A name would have to be looked up, and could be anybody's.
constexpr const char* kLinkLocal = "http://169.254.169.254";

}  // namespace

PreemptionWatch::PreemptionWatch(Cloud cloud, const std::string& endpoint, Listener& listener)
    : listener_(listener),
      metadata_(std::make_unique<Metadata>(endpoint.empty() ? kLinkLocal : endpoint)),
      thread_([this, cloud] { run(cloud); }) {}

PreemptionWatch::~PreemptionWatch() {
  {
    const core::MutexLock lock(mutex_);
    metadata_->stop();
  }
  wake_.notify_all();
  thread_.join();
}

void PreemptionWatch::run(Cloud cloud) {
  const auto source = make_notice_source(cloud, *metadata_);
  std::string told;
  while (!metadata_->stopped()) {
    const auto looked = source->look();
    if (metadata_->stopped()) return;
    if (looked && *looked) {
      listener_.preempted(**looked);
      return;
    }
    const std::string trouble = looked ? std::string() : looked.error().message;
    if (!trouble.empty() && trouble != told) listener_.watch_trouble(trouble);
    if (!trouble.empty()) told = trouble;
    const auto again = Clock::now() + source->pause();
    const core::MutexLock lock(mutex_);
    while (!metadata_->stopped() && Clock::now() < again) wake_.wait_until(mutex_, again);
  }
}

}  // namespace hyades::worker
