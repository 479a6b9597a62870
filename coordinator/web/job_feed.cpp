#include "coordinator/web/job_feed.h"

#include <utility>

#include "farm/json_form.h"

namespace hyades::coordinator {

JobFeed::~JobFeed() {
  if (watch_ != 0) controller_.watchers().unwatch(watch_);
}

void JobFeed::join(std::weak_ptr<LiveReader> reader) {
  {
    const std::lock_guard lock(mutex_);
    readers_.add(std::move(reader));
  }
  if (watch_ == 0)
    watch_ = controller_.watchers().watch(job_, [changed = changed_] { *changed = true; });
  *changed_ = true;
  tick();
}

bool JobFeed::tick() {
  {
    const std::lock_guard lock(mutex_);
    if (readers_.empty()) return false;
  }
  if (!*changed_ || stepping_.exchange(true)) return true;
  *changed_ = false;
  const bool taken = executors_.store.submit([me = shared_from_this()] {
    const grpc::Status done = within_memory([&] {
      me->step();
      return grpc::Status::OK;
    });
    if (!done.ok()) *me->changed_ = true;
    me->stepping_ = false;
  });
  if (!taken) {
    *changed_ = true;
    stepping_ = false;
  }
  return true;
}

/// By one thread at a time. Those who know hear of changes before those who have just come are told
/// everything, so that nobody ever sees a frame go back; what happens in between both hear of
/// next time, the newer ones perhaps twice.
void JobFeed::step() {
  LiveReaders::Group fresh;
  {
    const std::lock_guard lock(mutex_);
    fresh = readers_.take_fresh();
  }
  farm::Json change;
  farm::Json snapshot;
  bool ended = false;
  bool ended_for_fresh = false;
  grpc::Status status;
  if (begun_) status = changes(cursor_, change, ended);
  if (status.ok() && !fresh.empty()) {
    ChangeCursor all;
    status = changes(all, snapshot, ended_for_fresh);
    if (status.ok() && !std::exchange(begun_, true)) cursor_ = all;
  }
  const std::lock_guard lock(mutex_);
  if (status.error_code() == grpc::StatusCode::NOT_FOUND) {
    const farm::Json gone = {{"message", status.error_message()}};
    LiveReaders::tell(fresh, "gone", gone);
    readers_.tell("gone", gone);
    LiveReaders::end(fresh);
    return readers_.end();
  }
  if (!status.ok()) {  // the store does not answer: again
    readers_.put_back(std::move(fresh));
    *changed_ = true;
    return;
  }
  if (!change.is_null()) readers_.tell(ended ? "end" : "change", change);
  if (ended) readers_.end();
  if (fresh.empty()) return;
  LiveReaders::tell(fresh, "snapshot", snapshot);
  if (ended_for_fresh) {
    const farm::Json last = {{"job", snapshot["job"]}, {"frames", farm::Json::array()}};
    LiveReaders::tell(fresh, "end", last);
    LiveReaders::end(fresh);
    // Those who knew before hear of the end with the next step.
    if (!ended) *changed_ = true;
  } else {
    readers_.know(std::move(fresh));
  }
}

/// All pages of what has changed, as one.
grpc::Status JobFeed::changes(ChangeCursor& cursor, farm::Json& change, bool& ended) {
  farm::Json frames = farm::Json::array();
  for (;;) {
    v1::WatchEvent event;
    const grpc::Status status = controller_.queries().changes(job_, cursor, event, ended);
    if (!status.ok()) return status;
    for (const v1::Frame& frame : event.changed()) frames.push_back(farm::to_json(frame));
    if (event.more()) continue;
    change = {{"job", farm::to_json(event.job())}, {"frames", std::move(frames)}};
    return grpc::Status::OK;
  }
}

}  // namespace hyades::coordinator
