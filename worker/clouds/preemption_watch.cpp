#include "worker/clouds/preemption_watch.h"

#include "worker/clouds/metadata.h"
#include "worker/clouds/notice_source.h"

namespace hyades::worker {
namespace {

/// Where all three have it. A name would have to be looked up, and could be anybody's.
constexpr const char* kLinkLocal = "http://169.254.169.254";

}  // namespace

PreemptionWatch::PreemptionWatch(Cloud cloud, const std::string& endpoint, Owner& owner)
    : owner_(owner),
      metadata_(std::make_unique<Metadata>(endpoint.empty() ? kLinkLocal : endpoint)),
      thread_([this, cloud] { run(cloud); }) {}

PreemptionWatch::~PreemptionWatch() {
  {
    const std::lock_guard lock(mutex_);
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
      owner_.preempted(**looked);
      return;
    }
    const std::string trouble = looked ? std::string() : looked.error().message;
    if (!trouble.empty() && trouble != told) owner_.watch_trouble(trouble);
    if (!trouble.empty()) told = trouble;
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, source->pause(), [this] { return metadata_->stopped(); });
  }
}

}  // namespace hyades::worker
