// What comes as a stream of a job: its changes, outputs and log, and its files.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/file_transfer.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/service.h"
#include "core/base/result.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// Rows that are read at once: few at first, more as they turn out to be small. What is read ahead
/// waits in memory until the client has read what comes before it.
constexpr uint32_t kFewRows = 16;
constexpr uint32_t kManyRows = 500;
constexpr uint64_t kMostBytesAhead = uint64_t{64} << 10U;

/// Frames, or ranges of them, in one question; and of those ranges such as hold more than one
/// frame, each of which is looked at for each row.
constexpr int kMostFrames = 10'000;
constexpr int kMostLongRanges = 100;

bool is_long(const v1::FrameRange& range) { return range.first() != range.last(); }

grpc::Status too_many(int most, const char* what) {
  return {grpc::StatusCode::INVALID_ARGUMENT, fmt::format("at most {} {}", most, what)};
}

/// Whether outputs may be asked for so.
grpc::Status check(const v1::OutputsRequest& request) {
  if (request.frames_size() > kMostFrames) return too_many(kMostFrames, "ranges of frames");
  if (std::count_if(request.frames().begin(), request.frames().end(), is_long) > kMostLongRanges) {
    return too_many(kMostLongRanges, "ranges of more than one frame");
  }
  return grpc::Status::OK;
}

/// Follows a job: wakes up whenever it has changed.
template <class Message>
class Follower : public Producer<Message> {
 protected:
  Follower(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
           uint64_t job)
      : Producer<Message>(context, pool), controller_(controller), job_(job) {
    watch_ = controller.watchers().watch(job, [waker = this->waker()] { waker->wake(); });
  }
  void over() override { controller_.watchers().unwatch(watch_); }

  Controller& controller_;
  const uint64_t job_;

 private:
  uint64_t watch_ = 0;
};

/// Tells of a job and its frames as they change.
class JobChanges final : public Follower<v1::WatchEvent> {
 public:
  JobChanges(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
             uint64_t job)
      : Follower(context, pool, controller, job) {}

 private:
  Step next(v1::WatchEvent& event, grpc::Status& status, bool may_wait) override {
    if (ended_) return Step::end;
    const ChangeCursor before = cursor_;
    bool over = false;
    if (!controller_.queries().changes_of_open(job_, cursor_, event)) {
      if (!may_wait) return Step::needs_thread;
      status = controller_.queries().changes(job_, cursor_, event, over);
      if (!status.ok()) return Step::end;
    }
    ended_ = over && !event.more();
    const bool news = over || before.after || event.more() || cursor_.version != before.version;
    return news ? Step::message : Step::wait;
  }

  ChangeCursor cursor_;
  bool ended_ = false;
};

/// Tells of rows that the store has of a job, in the order of their numbers.
template <class Message, class Row>
class RowFollower : public Follower<Message> {
 protected:
  using Step = typename Producer<Message>::Step;

  /// Begins behind the row with number `after`. `follow`: waits for more until the job has ended.
  RowFollower(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
              uint64_t job, uint64_t after, bool follow)
      : Follower<Message>(context, pool, controller, job), after_(after), follow_(follow) {}

 private:
  /// The next rows behind `after`, at most `limit`.
  virtual core::Result<std::vector<Row>> read(uint64_t after, uint32_t limit) = 0;
  /// What a row takes in memory [bytes].
  virtual uint64_t bytes_of(const Row& row) const = 0;
  /// Whether a row that was just read is told.
  virtual bool wants(const Row& row, bool job_has_ended) = 0;
  /// Puts a row into an empty message.
  virtual void tell(const Row& row, Message& message) = 0;
  /// The job has ended, and all rows have been read: whether they are to be read once more.
  virtual bool wants_again() { return false; }

  Step next(Message& message, grpc::Status& status, bool may_wait) final {
    for (;;) {
      if (!ready_.empty()) {
        tell(ready_.front(), message);
        bytes_ahead_ -= bytes_of(ready_.front());
        ready_.pop_front();
        return Step::message;
      }
      if (!may_wait) return Step::needs_thread;
      bool job_has_ended = false;
      status = look(job_has_ended);
      if (!status.ok()) return Step::end;
      auto rows = read(after_, rows_at_once_);
      if (!rows) {
        status = farm::unavailable(rows.error());
        return Step::end;
      }
      if (!rows->empty()) {
        keep(*rows, job_has_ended);
      } else if (job_has_ended && wants_again()) {
        after_ = 0;
      } else {
        return job_has_ended || !follow_ ? Step::end : Step::wait;
      }
    }
  }

  /// Keeps those that are wanted, up to what may be ahead; the others are read again.
  void keep(std::vector<Row>& rows, bool job_has_ended) {
    for (Row& row : rows) {
      if (bytes_ahead_ >= kMostBytesAhead) break;
      after_ = row.number;
      if (!wants(row, job_has_ended)) continue;
      bytes_ahead_ += bytes_of(row);
      ready_.push_back(std::move(row));
    }
    rows_at_once_ = bytes_ahead_ < kMostBytesAhead / 2 ? std::min(2 * rows_at_once_, kManyRows)
                                                       : std::max(rows_at_once_ / 2, kFewRows);
  }

  uint64_t bytes_ahead() const final { return bytes_ahead_; }

  /// Whether the job has ended, or why it cannot be followed.
  grpc::Status look(bool& job_has_ended) {
    v1::WatchEvent event;
    cursor_.version = std::max<uint64_t>(cursor_.version, 1);
    return this->controller_.queries().changes(this->job_, cursor_, event, job_has_ended);
  }

  ChangeCursor cursor_;
  std::deque<Row> ready_;
  uint64_t bytes_ahead_ = 0;  ///< of ready_
  uint32_t rows_at_once_ = kFewRows;
  uint64_t after_;  ///< the number of the row that was read last
  const bool follow_;
};

/// Tells of finished files.
class OutputList final : public RowFollower<v1::OutputFile, StoredOutput> {
 public:
  OutputList(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
             const v1::OutputsRequest& request)
      : RowFollower(context, pool, controller, request.job(), 0, request.follow()),
        all_frames_(request.frames().empty()) {
    for (const v1::FrameRange& range : request.frames()) {
      if (is_long(range)) {
        ranges_.push_back(range);
      } else {
        frames_.insert(range.first());
      }
    }
  }

 private:
  core::Result<std::vector<StoredOutput>> read(uint64_t after, uint32_t limit) override {
    return controller_.store().outputs(job_, after, limit);
  }
  uint64_t bytes_of(const StoredOutput& output) const override {
    return sizeof(output) + output.path.size() + output.sha256.size();
  }

  bool wants(const StoredOutput& output, bool job_has_ended) override {
    if (!is_asked_for(output.frame)) return false;
    if (again_) {
      return output.number <= passed_over_until_ && passed_over_.contains(folder_of(output));
    }
    // Those for a video go when it is made, and are of use only where it never will be.
    if (job_has_ended || !controller_.queries().is_for_video(job_, output.path)) return true;
    passed_over_.insert(folder_of(output));
    passed_over_until_ = output.number;
    return false;
  }

  static std::string folder_of(const StoredOutput& output) {
    return std::filesystem::path(output.path).parent_path().string();
  }

  bool is_asked_for(int32_t frame) const {
    if (all_frames_ || frames_.contains(frame)) return true;
    return std::any_of(ranges_.begin(), ranges_.end(), [&](const v1::FrameRange& r) {
      const int64_t step = r.step() > 0 ? r.step() : 1;
      return frame >= r.first() && frame <= r.last() && (int64_t{frame} - r.first()) % step == 0;
    });
  }

  void tell(const StoredOutput& output, v1::OutputFile& message) override {
    message.set_path(output.path);
    message.set_frame(output.frame);
    message.set_size(output.size);
    message.set_sha256(output.sha256);
  }

  bool wants_again() override { return !std::exchange(again_, true) && !passed_over_.empty(); }

  const bool all_frames_;
  std::set<int32_t> frames_;  ///< that are asked for one by one
  std::vector<v1::FrameRange> ranges_;
  std::set<std::string> passed_over_;  ///< folders of videos' pictures, as long as the job was open
  uint64_t passed_over_until_ = 0;     ///< the number of the last of those
  bool again_ = false;  ///< only those that were passed over, and are still there, are told
};

/// Tells of the lines of the log.
class LogLines final : public RowFollower<v1::LogLine, StoredLine> {
 public:
  LogLines(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
           const v1::LogsRequest& request)
      : RowFollower(context, pool, controller, request.job(), request.after(), request.follow()),
        frames_(request.frames().begin(), request.frames().end()) {}

 private:
  core::Result<std::vector<StoredLine>> read(uint64_t after, uint32_t limit) override {
    return controller_.store().lines(job_, after, limit);
  }
  uint64_t bytes_of(const StoredLine& line) const override {
    return sizeof(line) + line.worker.size() + line.text.size();
  }

  bool wants(const StoredLine& line, bool /*job_has_ended*/) override {
    return frames_.empty() || (line.frame && frames_.contains(*line.frame));
  }

  void tell(const StoredLine& line, v1::LogLine& message) override {
    message.set_time_ms(line.time_ms);
    message.set_level(static_cast<v1::LogLevel>(line.level));
    message.set_of_frame(line.frame.has_value());
    message.set_frame(line.frame.value_or(0));
    message.set_worker(line.worker);
    message.set_text(line.text);
    message.set_number(line.number);
  }

  const std::set<int32_t> frames_;  ///< none: all
};

/// The file of an output as it was listed. DATA_LOSS where it changes meanwhile.
grpc::Status open(Controller& controller, const v1::FetchRequest& request, FileToSend& file) {
  StoredOutput output;
  core::MadeFile made;
  grpc::Status opened = open_output(controller, request.job(), request.path(), output, made);
  if (!opened.ok()) return opened;
  if (!request.sha256().empty() && request.sha256() != output.sha256) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            request.path() + " has been rendered again: fetch it from its beginning"};
  }
  file.size = made.size();
  file.read = [made, path = request.path()](uint64_t offset, std::span<std::byte> into) {
    return made.read(offset, into) ? grpc::Status::OK : damaged_output(path);
  };
  return grpc::Status::OK;
}

}  // namespace

void add_job_streams(Service& service) {
  Controller& controller = service.backend().controller;
  using Context = Service::Context;
  service.add_server_stream<v1::WatchRequest>(
      "Jobs/Watch",
      [&controller, &pool = service.pool_of("Jobs/Watch")](
          Context& context, const Caller& /*caller*/, v1::WatchRequest&& request, grpc::Status&) {
        return new JobChanges(context, pool, controller, request.job());
      });
  service.add_server_stream<v1::OutputsRequest>(
      "Jobs/Outputs",
      [&controller, &pool = service.pool_of("Jobs/Outputs")](
          Context& context, const Caller& /*caller*/, v1::OutputsRequest&& request,
          grpc::Status& refused) -> OutgoingStream* {
        refused = check(request);
        if (!refused.ok()) return nullptr;
        return new OutputList(context, pool, controller, request);
      });
  service.add_server_stream<v1::LogsRequest>(
      "Jobs/Logs",
      [&controller, &pool = service.pool_of("Jobs/Logs")](
          Context& context, const Caller& /*caller*/, v1::LogsRequest&& request,
          grpc::Status& refused) -> OutgoingStream* {
        if (request.frames_size() <= kMostFrames) {
          return new LogLines(context, pool, controller, request);
        }
        refused = too_many(kMostFrames, "frames");
        return nullptr;
      });
  service.add_server_stream<v1::FetchRequest>(
      "Jobs/Fetch",
      [&controller, &pool = service.pool_of("Jobs/Fetch")](
          Context& context, const Caller& /*caller*/, v1::FetchRequest&& request, grpc::Status&) {
        return new FileStream(
            context, pool,
            [&controller, request](FileToSend& file) { return open(controller, request, file); },
            request.offset());
      });
}

}  // namespace hyades::coordinator
