#include "coordinator/web/job_feed.h"

#include <utility>

#include "farm/json_form.h"

namespace hyades::coordinator {

JobFeed::~JobFeed() {
  if (watch_ != 0) brain_.unwatch(watch_);
}

void JobFeed::join(std::weak_ptr<LiveReader> reader) {
  {
    const std::lock_guard lock(mutex_);
    readers_.add(std::move(reader));
  }
  if (watch_ == 0) watch_ = brain_.watch(job_, [changed = changed_] { *changed = true; });
  *changed_ = true;
  tick();
}

bool JobFeed::tick() {
  if (over_) return false;
  {
    const std::lock_guard lock(mutex_);
    if (readers_.empty()) return false;
  }
  if (!*changed_ || stepping_.exchange(true)) return true;
  *changed_ = false;
  const bool taken = desks_.rows.hand([me = shared_from_this()] {
    me->step();
    me->stepping_ = false;
  });
  if (!taken) {
    *changed_ = true;
    stepping_ = false;
  }
  return true;
}

/// By one clerk at a time: what those who know are told comes before what those who are new are,
/// so that nobody ever sees a frame go back.
void JobFeed::step() {
  bool fresh = false;
  bool known = false;
  {
    const std::lock_guard lock(mutex_);
    fresh = readers_.has_fresh();
    known = begun_;
  }
  farm::Json change;
  farm::Json snapshot;
  bool ended = false;
  if (known) {
    if (!changes(told_, change, ended).ok()) {
      *changed_ = true;
      return;
    }
  }
  if (fresh) {
    Brain::ToldOf all;
    const grpc::Status status = changes(all, snapshot, ended);
    if (!status.ok()) {
      const std::lock_guard lock(mutex_);
      readers_.greet({{"error", status.error_message()}});
      readers_.end();
      over_ = status.error_code() == grpc::StatusCode::NOT_FOUND;
      *changed_ = true;
      return;
    }
    // Both are told of the same changes from now on.
    told_ = all;
    begun_ = true;
  }
  const std::lock_guard lock(mutex_);
  if (known) readers_.tell(ended ? "end" : "change", change);
  if (fresh) readers_.greet(snapshot);
  if (!ended) return;
  if (fresh) readers_.tell("end", {{"job", snapshot["job"]}, {"frames", farm::Json::array()}});
  readers_.end();
  over_ = true;
}

/// All pages of what has changed, as one.
grpc::Status JobFeed::changes(Brain::ToldOf& told, farm::Json& change, bool& ended) {
  farm::Json frames = farm::Json::array();
  for (;;) {
    v1::WatchEvent event;
    const grpc::Status status = brain_.changes(job_, told, event, ended);
    if (!status.ok()) return status;
    for (const v1::Frame& frame : event.changed()) frames.push_back(farm::to_json(frame));
    if (event.more()) continue;
    change = {{"job", farm::to_json(event.job())}, {"frames", std::move(frames)}};
    return grpc::Status::OK;
  }
}

}  // namespace hyades::coordinator
