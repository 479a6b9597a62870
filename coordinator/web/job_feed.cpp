#include "coordinator/web/job_feed.h"

#include <utility>

namespace hyades::coordinator {

JobFeed::~JobFeed() {
  if (watch_ != 0) controller_.watchers().unwatch(watch_);
}

void JobFeed::join(std::weak_ptr<LiveReader> reader) {
  {
    const core::MutexLock lock(mutex_);
    readers_.add(std::move(reader));
  }
  if (watch_ == 0)
    watch_ = controller_.watchers().watch(job_, [changed = changed_] { *changed = true; });
  *changed_ = true;
  tick();
}

bool JobFeed::tick() {
  {
    const core::MutexLock lock(mutex_);
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
  bool fresh = false;
  {
    const core::MutexLock lock(mutex_);
    fresh = readers_.has_fresh();
  }
  // What cannot be told now is told with the next step.
  Changes changes{.cursor = cursor_};
  Changes all;
  grpc::Status status;
  if (begun_) status = read(changes);
  if (status.ok() && fresh) status = read(all);
  if (status.error_code() == grpc::StatusCode::NOT_FOUND) return tell_gone(status.error_message());
  if (!status.ok()) {  // the store does not answer: again
    *changed_ = true;
    return;
  }
  if (begun_) tell_those_who_know(changes);
  if (fresh) tell_newcomers(all);
  // Those who knew before hear of the end with the next step.
  if (all.ended && !changes.ended) *changed_ = true;
}

/// All pages of what has changed since news.cursor, as one.
grpc::Status JobFeed::read(Changes& news) {
  farm::Json frames = farm::Json::array();
  for (;;) {
    v1::WatchEvent event;
    const grpc::Status status = controller_.queries().changes(job_, news.cursor, event, news.ended);
    if (!status.ok()) return status;
    for (const v1::Frame& frame : event.changed()) frames.push_back(farm::to_json(frame));
    if (event.more()) continue;
    news.json = {{"job", farm::to_json(event.job())}, {"frames", std::move(frames)}};
    return grpc::Status::OK;
  }
}

// Bytes are made before the lock is taken, as the network's thread waits for it.

void JobFeed::tell_those_who_know(const Changes& changes) {
  const auto event = LiveReaders::event(changes.ended ? "end" : "change", changes.json);
  cursor_ = changes.cursor;
  const core::MutexLock lock(mutex_);
  readers_.tell(event);
  if (changes.ended) readers_.end();
}

void JobFeed::tell_newcomers(const Changes& all) {
  const auto first = LiveReaders::event("snapshot", all.json);
  const auto last =
      LiveReaders::event("end", {{"job", all.json["job"]}, {"frames", farm::Json::array()}});
  if (!std::exchange(begun_, true)) cursor_ = all.cursor;
  const core::MutexLock lock(mutex_);
  LiveReaders::Group newcomers = readers_.take_fresh();
  LiveReaders::tell(newcomers, first);
  if (!all.ended) return readers_.know(std::move(newcomers));
  LiveReaders::tell(newcomers, last);
  LiveReaders::end(newcomers);
}

void JobFeed::tell_gone(const std::string& message) {
  const auto gone = LiveReaders::event("gone", {{"message", message}});
  const core::MutexLock lock(mutex_);
  readers_.know(readers_.take_fresh());
  readers_.tell(gone);
  readers_.end();
}

}  // namespace hyades::coordinator
