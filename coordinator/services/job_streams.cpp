// What of a job comes as a stream.
#include <algorithm>
#include <atomic>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/service.h"
#include "core/base/assets.h"
#include "core/film/film_codec.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kRowsAtOnce = 500;

constexpr int kMostAsked = 10'000;
/// Films on their way at once: each is in memory as a whole.
constexpr int kMostFilms = 4;

grpc::Status too_many(const char* what) {
  return {grpc::StatusCode::INVALID_ARGUMENT, fmt::format("at most {} {}", kMostAsked, what)};
}

/// Follows a job: wakes up whenever it has changed.
template <class Message>
class Follower : public Producer<Message> {
 protected:
  Follower(grpc::CallbackServerContext& context, ThreadPool& pool, Controller& controller,
           uint64_t job)
      : Producer<Message>(context, pool), controller_(controller), job_(job) {
    watch_ = controller.watchers().watch(job, [poker = this->poker()] { poker->poke(); });
  }
  void over() override { controller_.watchers().unwatch(watch_); }

  /// Whether nothing can come any more, or why the job cannot be followed.
  grpc::Status ended(bool& ended) {
    v1::WatchEvent event;
    cursor_.version = std::max<uint64_t>(cursor_.version, 1);
    return controller_.queries().changes(job_, cursor_, event, ended);
  }

  Controller& controller_;
  const uint64_t job_;
  ChangeCursor cursor_;

 private:
  uint64_t watch_ = 0;
};

class Watching final : public Follower<v1::WatchEvent> {
 public:
  Watching(grpc::CallbackServerContext& context, ThreadPool& pool, Controller& controller,
           uint64_t job)
      : Follower(context, pool, controller, job) {}

 private:
  Step next(v1::WatchEvent& event, grpc::Status& status, bool may_wait) override {
    if (ended_) return Step::end;
    const ChangeCursor before = cursor_;
    bool over = false;
    if (!controller_.queries().changes_of_open(job_, cursor_, event)) {
      if (!may_wait) return Step::hand;
      status = controller_.queries().changes(job_, cursor_, event, over);
      if (!status.ok()) return Step::end;
    }
    ended_ = over && !event.more();
    const bool news = over || before.after || event.more() || cursor_.version != before.version;
    return news ? Step::message : Step::wait;
  }
  bool ended_ = false;
};

class OutputList final : public Follower<v1::OutputFile> {
 public:
  OutputList(grpc::CallbackServerContext& context, ThreadPool& pool, Controller& controller,
             const v1::OutputsRequest& request)
      : Follower(context, pool, controller, request.job()), request_(request) {}

 private:
  bool wanted(int32_t frame) const {
    if (request_.frames().empty()) return true;
    return std::any_of(request_.frames().begin(), request_.frames().end(),
                       [&](const v1::FrameRange& r) {
                         const int64_t step = r.step() > 0 ? r.step() : 1;
                         return frame >= r.first() && frame <= r.last() &&
                                (int64_t{frame} - r.first()) % step == 0;
                       });
  }

  Step next(v1::OutputFile& message, grpc::Status& status, bool may_wait) override {
    for (;;) {
      while (!ready_.empty()) {
        const StoredOutput output = std::move(ready_.front());
        ready_.pop_front();
        if (!wanted(output.frame)) continue;
        message.set_path(output.path);
        message.set_frame(output.frame);
        message.set_size(output.size);
        message.set_sha256(output.sha256);
        return Step::message;
      }
      if (phase_ == Phase::all_told) return Step::end;
      if (!may_wait) return Step::hand;
      bool over = false;
      status = ended(over);
      if (!status.ok()) return Step::end;
      auto outputs = controller_.store().outputs(job_, seen_, kRowsAtOnce);
      if (!outputs) {
        status = farm::unavailable(outputs.error());
        return Step::end;
      }
      if (!outputs->empty()) {
        seen_ = outputs->back().number;
        take(*outputs, over);
      } else if (over && phase_ == Phase::as_finished && !passed_over_.empty()) {
        phase_ = Phase::left_over;
        seen_ = 0;
      } else if (over || !request_.follow()) {
        phase_ = Phase::all_told;
      } else {
        return Step::wait;
      }
    }
  }

  void take(const std::vector<StoredOutput>& outputs, bool job_is_over) {
    for (const StoredOutput& output : outputs) {
      // Those for a video go when it is made, and are of use only where it never will be.
      if (!job_is_over && controller_.queries().is_for_video(job_, output.path)) {
        passed_over_.insert(output.path);
      } else if (phase_ == Phase::as_finished || passed_over_.contains(output.path)) {
        ready_.push_back(output);
      }
    }
  }

  enum class Phase {
    as_finished,  ///< in the order of their numbers
    left_over,    ///< the job has ended: those that were passed over and are still there
    all_told
  };

  const v1::OutputsRequest request_;
  std::deque<StoredOutput> ready_;
  Phase phase_ = Phase::as_finished;
  uint64_t seen_ = 0;                  ///< the number of the phase's last one
  std::set<std::string> passed_over_;  ///< paths of a video's pictures, as long as the job was open
};

class LogLines final : public Follower<v1::LogLine> {
 public:
  LogLines(grpc::CallbackServerContext& context, ThreadPool& pool, Controller& controller,
           const v1::LogsRequest& request)
      : Follower(context, pool, controller, request.job()),
        request_(request),
        seen_(request.after()) {
    frames_.insert(request.frames().begin(), request.frames().end());
  }

 private:
  Step next(v1::LogLine& message, grpc::Status& status, bool may_wait) override {
    for (;;) {
      while (!ready_.empty()) {
        const StoredLine line = std::move(ready_.front());
        ready_.pop_front();
        if (!frames_.empty() && (!line.frame || !frames_.contains(*line.frame))) continue;
        message.set_time_ms(line.time_ms);
        message.set_level(static_cast<v1::LogLevel>(line.level));
        message.set_of_frame(line.frame.has_value());
        message.set_frame(line.frame.value_or(0));
        message.set_worker(line.worker);
        message.set_text(line.text);
        message.set_number(line.number);
        return Step::message;
      }
      if (last_) return Step::end;
      if (!may_wait) return Step::hand;
      bool over = false;
      status = ended(over);
      if (!status.ok()) return Step::end;
      auto lines = controller_.store().lines(job_, seen_, kRowsAtOnce);
      if (!lines) {
        status = farm::unavailable(lines.error());
        return Step::end;
      }
      if (!lines->empty()) seen_ = lines->back().number;
      ready_.insert(ready_.end(), lines->begin(), lines->end());
      if (!ready_.empty()) continue;
      last_ = over || !request_.follow();
      if (!last_) return Step::wait;
    }
  }

  const v1::LogsRequest request_;
  std::set<int32_t> frames_;
  std::deque<StoredLine> ready_;
  uint64_t seen_;  ///< the number of the last line
  bool last_ = false;
};

class FilmStream final : public Producer<v1::FilmPart> {
 public:
  /// `open` counts such streams.
  FilmStream(grpc::CallbackServerContext& context, ThreadPool& pool, Controller& controller,
             v1::FilmRequest request, std::shared_ptr<std::atomic<int>> open)
      : Producer(context, pool),
        controller_(controller),
        request_(std::move(request)),
        open_(std::move(open)),
        found_(std::make_shared<Found>()) {
    ++*open_;
  }

  ~FilmStream() override { --*open_; }

 private:
  struct Found {
    std::atomic<bool> there{false};
    grpc::Status status;
    core::FilmInfo info;
    std::shared_ptr<const core::Film> film;
  };

  /// The stream may be over before the film is found.
  void ask() {
    const grpc::Status asked = controller_.queries().film(
        request_.job(), request_.frame(),
        [found = found_, poker = poker()](const grpc::Status& said, const core::FilmInfo& info,
                                          std::shared_ptr<const core::Film> film) {
          found->status = said;
          found->info = info;
          found->film = std::move(film);
          found->there = true;
          poker->poke();
        });
    if (asked.ok()) return;
    found_->status = asked;
    found_->there = true;
  }

  Step next(v1::FilmPart& part, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::hand;
    if (!std::exchange(asked_, true)) ask();
    if (!found_->there) return Step::wait;
    if (!found_->status.ok()) {
      status = found_->status;
      return Step::end;
    }
    if (found_->film) {
      bytes_ = core::encode_film(*found_->film);
      found_->film.reset();
      *part.mutable_header() = farm::to_wire(found_->info);
      part.mutable_header()->set_size(bytes_.size());
      return Step::message;
    }
    if (offset_ >= bytes_.size()) return Step::end;
    const uint64_t count = std::min<uint64_t>(farm::kMaxChunkBytes, bytes_.size() - offset_);
    part.mutable_chunk()->set_offset(offset_);
    part.mutable_chunk()->set_data(bytes_.data() + offset_, count);
    offset_ += count;
    return Step::message;
  }

  Controller& controller_;
  const v1::FilmRequest request_;
  const std::shared_ptr<std::atomic<int>> open_;
  const std::shared_ptr<Found> found_;
  bool asked_ = false;
  std::vector<std::byte> bytes_;
  uint64_t offset_ = 0;
};

/// The bytes of an output as it was listed.
grpc::Status open_output(Controller& controller, const v1::FetchRequest& request,
                         core::Bytes& file) {
  // The path is looked up among the job's outputs and never taken for one of the file system's.
  const auto output = controller.store().output(request.job(), request.path());
  if (!output) return farm::unavailable(output.error());
  if (!*output) {
    return {grpc::StatusCode::NOT_FOUND,
            fmt::format("job {} has no output '{}' (yet)", request.job(), request.path())};
  }
  if (!request.sha256().empty() && request.sha256() != (*output)->sha256) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            request.path() + " has been rendered again: fetch it from its beginning"};
  }
  auto bytes = core::map_file(controller.output_folder(request.job()) + "/" + (*output)->path);
  if (!bytes || bytes->size() != (*output)->size) {
    return {grpc::StatusCode::DATA_LOSS, request.path() + " is damaged on the coordinator's disk"};
  }
  file = std::move(*bytes);
  return grpc::Status::OK;
}

}  // namespace

void add_job_streams(Service& service) {
  Controller& controller = service.backend().controller;
  ThreadPool& store = service.executors().store;
  ThreadPool& files = service.executors().files;
  using Context = Service::Context;
  service.add_reader<v1::WatchRequest>(
      "Jobs/Watch", [&](Context& context, v1::WatchRequest&& request, grpc::Status&) {
        return new Watching(context, store, controller, request.job());
      });
  service.add_reader<v1::OutputsRequest>("Jobs/Outputs",
                                         [&](Context& context, v1::OutputsRequest&& request,
                                             grpc::Status& refused) -> OutgoingStream* {
                                           if (request.frames_size() <= kMostAsked) {
                                             return new OutputList(context, store, controller,
                                                                   request);
                                           }
                                           refused = too_many("ranges of frames");
                                           return nullptr;
                                         });
  service.add_reader<v1::LogsRequest>(
      "Jobs/Logs",
      [&](Context& context, v1::LogsRequest&& request, grpc::Status& refused) -> OutgoingStream* {
        if (request.frames_size() <= kMostAsked) {
          return new LogLines(context, store, controller, request);
        }
        refused = too_many("frames");
        return nullptr;
      });
  service.add_reader<v1::FetchRequest>(
      "Jobs/Fetch", [&](Context& context, v1::FetchRequest&& request, grpc::Status&) {
        const uint64_t offset = request.offset();
        return new FileStream(
            context, files,
            [&controller, request = std::move(request)](core::Bytes& file) {
              return open_output(controller, request, file);
            },
            offset);
      });
  service.add_reader<v1::FilmRequest>(
      "Jobs/Film",
      [&, films = std::make_shared<std::atomic<int>>(0)](
          Context& context, v1::FilmRequest&& request, grpc::Status& refused) -> OutgoingStream* {
        if (*films < kMostFilms) {
          return new FilmStream(context, files, controller, std::move(request), films);
        }
        refused =
            farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                              "enough films are on their way to others", std::chrono::seconds(2));
        return nullptr;
      });
}

}  // namespace hyades::coordinator
