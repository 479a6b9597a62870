#include "coordinator/web/job_feed.h"

#include <cstddef>
#include <optional>
#include <utility>

namespace hyades::coordinator {
namespace {

std::string text_of(const farm::Json& json) {
  return json.dump(-1, ' ', false, farm::Json::error_handler_t::replace);
}

farm::Json frames_of(const v1::WatchEvent& event) {
  farm::Json frames = farm::Json::array();
  for (const v1::Frame& frame : event.changed()) frames.push_back(farm::to_json(frame));
  return frames;
}

}  // namespace

/// The event with which a stream begins, in pieces, as fast as its reader takes them.
class JobFeed::Snapshot final : public BodySource {
 public:
  Snapshot(Controller& controller, uint64_t job) : controller_(controller), job_(job) {}

  std::optional<std::string> next() override {
    std::string piece;
    const grpc::Status done = within_memory([&] { return add_page(piece); });
    if (!done.ok()) return std::nullopt;
    return piece;
  }
  std::optional<uint64_t> size() const override { return std::nullopt; }

  const ChangeCursor& cursor() const { return cursor_; }
  /// The job has, and all is told.
  bool ended() const { return ended_; }

 private:
  grpc::Status add_page(std::string& piece) {
    if (over_) return grpc::Status::OK;
    v1::WatchEvent event;
    grpc::Status status = controller_.queries().changes(job_, cursor_, event, ended_);
    if (!status.ok()) return status;
    if (!std::exchange(begun_, true)) piece = "event: snapshot\ndata: {\"frames\":[";
    for (const v1::Frame& frame : event.changed()) {
      if (std::exchange(has_frames_, true)) piece += ',';
      piece += text_of(farm::to_json(frame));
    }
    if (event.more()) return status;
    over_ = true;
    const farm::Json job = farm::to_json(event.job());
    piece += "],\"job\":" + text_of(job) + "}\n\n";
    if (ended_)
      piece += *LiveReaders::event("end", {{"job", job}, {"frames", farm::Json::array()}});
    return status;
  }

  Controller& controller_;
  const uint64_t job_;
  ChangeCursor cursor_;
  bool begun_ = false;
  bool has_frames_ = false;
  bool over_ = false;
  bool ended_ = false;
};

/// What follows a snapshot.
class JobFeed::AfterSnapshot final : public LiveTopic {
 public:
  AfterSnapshot(std::shared_ptr<JobFeed> feed, std::shared_ptr<const Snapshot> snapshot)
      : feed_(std::move(feed)), snapshot_(std::move(snapshot)) {}

  void join(std::weak_ptr<LiveReader> reader) override {
    if (!snapshot_->ended()) return feed_->join(std::move(reader), snapshot_->cursor());
    if (const auto there = reader.lock()) there->end();
  }

 private:
  const std::shared_ptr<JobFeed> feed_;
  const std::shared_ptr<const Snapshot> snapshot_;
};

JobFeed::~JobFeed() {
  if (watch_ != 0) controller_.watchers().unwatch(watch_);
}

void JobFeed::tell(WebReply& reply) {
  auto snapshot = std::make_shared<Snapshot>(controller_, job_);
  reply.source = snapshot;
  reply.topic = std::make_shared<AfterSnapshot>(shared_from_this(), std::move(snapshot));
}

void JobFeed::join(std::weak_ptr<LiveReader> reader, const ChangeCursor& cursor) {
  {
    const core::MutexLock lock(mutex_);
    newcomers_.push_back({std::move(reader), cursor});
  }
  if (watch_ == 0) {
    watch_ = controller_.watchers().watch(job_, [changed = changed_] { *changed = true; });
  }
  *changed_ = true;
  tick();
}

bool JobFeed::tick() {
  {
    const core::MutexLock lock(mutex_);
    if (readers_.empty() && newcomers_.empty()) return false;
  }
  if (!*changed_ || stepping_.exchange(true)) return true;
  *changed_ = false;
  const bool taken = executors_.store.submit([me = shared_from_this()] {
    const grpc::Status done = within_memory([&] { return me->step(); });
    if (done.error_code() == grpc::StatusCode::NOT_FOUND) {
      me->tell_gone(done.error_message());
    } else if (!done.ok()) {  // the store does not answer, say: again
      *me->changed_ = true;
    }
    me->stepping_ = false;
  });
  if (!taken) {
    *changed_ = true;
    stepping_ = false;
  }
  return true;
}

/// By one thread at a time. Those who know hear of changes before those who have just come hear of
/// what has changed since their snapshots, so that nobody ever sees a frame go back; what happens
/// in between both hear of next time, the newer ones perhaps twice.
grpc::Status JobFeed::step() {
  if (begun_) {
    const grpc::Status told = tell_changes(cursor_, nullptr);
    if (!told.ok()) return told;
  }
  LiveReaders::Group fresh;
  ChangeCursor from;
  {
    const core::MutexLock lock(mutex_);
    for (const Newcomer& one : newcomers_) {
      if (fresh.empty() || one.cursor.version < from.version) from = one.cursor;
      fresh.push_back(one.reader);
    }
  }
  if (fresh.empty()) return grpc::Status::OK;
  const grpc::Status told = tell_changes(from, &fresh);
  if (!told.ok()) return told;
  if (!std::exchange(begun_, true)) cursor_ = from;
  const core::MutexLock lock(mutex_);
  newcomers_.erase(newcomers_.begin(), newcomers_.begin() + static_cast<ptrdiff_t>(fresh.size()));
  readers_.know(std::move(fresh));
  return grpc::Status::OK;
}

/// Tells what has changed since `cursor`, and moves that on: to these readers, or (null) to those
/// who know.
grpc::Status JobFeed::tell_changes(ChangeCursor& cursor, const LiveReaders::Group* readers) {
  for (bool more = true; more;) {
    v1::WatchEvent event;
    bool ended = false;
    const grpc::Status status = controller_.queries().changes(job_, cursor, event, ended);
    if (!status.ok()) return status;
    more = event.more();
    ended = ended && !more;
    // The bytes first: the network's thread waits for the lock.
    const auto bytes =
        LiveReaders::event(ended ? "end" : "change",
                           {{"job", farm::to_json(event.job())}, {"frames", frames_of(event)}});
    const core::MutexLock lock(mutex_);
    if (readers != nullptr) {
      LiveReaders::tell(*readers, bytes);
      if (ended) LiveReaders::end(*readers);
    } else {
      readers_.tell(bytes);
      if (ended) readers_.end();
    }
  }
  return grpc::Status::OK;
}

void JobFeed::tell_gone(const std::string& message) {
  const auto gone = LiveReaders::event("gone", {{"message", message}});
  const core::MutexLock lock(mutex_);
  for (Newcomer& one : newcomers_) readers_.know({std::move(one.reader)});
  newcomers_.clear();
  readers_.tell(gone);
  readers_.end();
}

}  // namespace hyades::coordinator
