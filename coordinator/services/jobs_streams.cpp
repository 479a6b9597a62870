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

#include "coordinator/services/file_stream.h"
#include "coordinator/services/jobs_service.h"
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

/// A request of a caller that is admitted.
template <class Request>
grpc::Status take_in(const Admission& admission, const char* method,
                     const grpc::CallbackServerContext& context, const grpc::ByteBuffer& bytes,
                     Request& request, Caller& caller) {
  const grpc::Status admitted = admission.check(context, rule_of_method(method), caller);
  return admitted.ok() ? parse(bytes, farm::kMaxRequestBytes, request) : admitted;
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
    told_.version = std::max<uint64_t>(told_.version, 1);
    return controller_.queries().changes(job_, told_, event, ended);
  }

  Controller& controller_;
  const uint64_t job_;
  ChangeCursor told_;

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
    const ChangeCursor before = told_;
    bool over = false;
    if (!controller_.queries().changes_of_open(job_, told_, event)) {
      if (!may_wait) return Step::hand;
      status = controller_.queries().changes(job_, told_, event, over);
      if (!status.ok()) return Step::end;
    }
    ended_ = over && !event.more();
    const bool news = over || before.after || event.more() || told_.version != before.version;
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
      if (last_) return Step::end;
      if (!may_wait) return Step::hand;
      bool over = false;
      status = ended(over);
      if (!status.ok()) return Step::end;
      auto outputs = controller_.store().outputs(job_, seen_, kRowsAtOnce);
      if (!outputs) {
        status = farm::unavailable(outputs.error());
        return Step::end;
      }
      const bool all = outputs->empty();
      if (!all) seen_ = outputs->back().number;
      for (const StoredOutput& output : *outputs) {
        // Those for a video go when it is made, and are of use only where it never will be.
        if (!over && controller_.queries().is_for_video(job_, output.path)) {
          passed_over_.insert(output.path);
        } else if (!again_ || passed_over_.contains(output.path)) {
          ready_.push_back(output);
        }
      }
      if (!all) continue;
      if (over && !again_ && !passed_over_.empty()) {
        again_ = true;
        seen_ = 0;
        continue;
      }
      last_ = over || !request_.follow();
      if (!last_) return Step::wait;
    }
  }

  const v1::OutputsRequest request_;
  std::deque<StoredOutput> ready_;
  uint64_t seen_ = 0;                  ///< the number of the last one
  std::set<std::string> passed_over_;  ///< paths of a video's pictures, as long as the job was open
  bool again_ = false;                 ///< the job has ended: those of them that are left
  bool last_ = false;
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
             v1::FilmRequest request, std::atomic<int>& open)
      : Producer(context, pool),
        controller_(controller),
        request_(std::move(request)),
        open_(open),
        found_(std::make_shared<Found>()) {
    ++open_;
    begin();
  }

  ~FilmStream() override { --open_; }

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
  std::atomic<int>& open_;
  const std::shared_ptr<Found> found_;
  bool asked_ = false;
  std::vector<std::byte> bytes_;
  uint64_t offset_ = 0;
};

}  // namespace

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobsService::Watch(Context* context,
                                                               const Bytes* asked) {
  v1::WatchRequest request;
  Caller caller;
  const grpc::Status taken = take_in(admission_, "Jobs/Watch", *context, *asked, request, caller);
  if (!taken.ok()) return new Refusal(taken);
  auto* stream = new Watching(*context, executors_.rows, controller_, request.job());
  stream->guard(admission_, caller);
  stream->begin();
  return stream;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobsService::Outputs(Context* context,
                                                                 const Bytes* asked) {
  v1::OutputsRequest request;
  Caller caller;
  grpc::Status taken = take_in(admission_, "Jobs/Outputs", *context, *asked, request, caller);
  if (taken.ok() && request.frames_size() > kMostAsked) taken = too_many("ranges of frames");
  if (!taken.ok()) return new Refusal(taken);
  auto* stream = new OutputList(*context, executors_.rows, controller_, request);
  stream->guard(admission_, caller);
  stream->begin();
  return stream;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobsService::Logs(Context* context,
                                                              const Bytes* asked) {
  v1::LogsRequest request;
  Caller caller;
  grpc::Status taken = take_in(admission_, "Jobs/Logs", *context, *asked, request, caller);
  if (taken.ok() && request.frames_size() > kMostAsked) taken = too_many("frames");
  if (!taken.ok()) return new Refusal(taken);
  auto* stream = new LogLines(*context, executors_.rows, controller_, request);
  stream->guard(admission_, caller);
  stream->begin();
  return stream;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobsService::Fetch(Context* context,
                                                               const Bytes* asked) {
  v1::FetchRequest request;
  Caller caller;
  const grpc::Status taken = take_in(admission_, "Jobs/Fetch", *context, *asked, request, caller);
  if (!taken.ok()) return new Refusal(taken);
  const uint64_t offset = request.offset();
  const auto open = [this, request = std::move(request)](core::Bytes& file) -> grpc::Status {
    // The path is looked up among the job's outputs and never taken for one of the file system's.
    const auto output = controller_.store().output(request.job(), request.path());
    if (!output) return farm::unavailable(output.error());
    if (!*output) {
      return {grpc::StatusCode::NOT_FOUND,
              fmt::format("job {} has no output '{}' (yet)", request.job(), request.path())};
    }
    if (!request.sha256().empty() && request.sha256() != (*output)->sha256) {
      return {grpc::StatusCode::FAILED_PRECONDITION,
              request.path() + " has been rendered again: fetch it from its beginning"};
    }
    auto bytes = core::map_file(controller_.output_folder(request.job()) + "/" + (*output)->path);
    if (!bytes || bytes->size() != (*output)->size) {
      return {grpc::StatusCode::DATA_LOSS,
              request.path() + " is damaged on the coordinator's disk"};
    }
    file = std::move(*bytes);
    return grpc::Status::OK;
  };
  auto* stream = new FileStream(*context, executors_.files, open, offset);
  stream->guard(admission_, caller);
  return stream;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobsService::Film(Context* context,
                                                              const Bytes* asked) {
  v1::FilmRequest request;
  Caller caller;
  const grpc::Status taken = take_in(admission_, "Jobs/Film", *context, *asked, request, caller);
  if (!taken.ok()) return new Refusal(taken);
  if (films_ >= kMostFilms) {
    return new Refusal(farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                         "enough films are on their way to others",
                                         std::chrono::seconds(2)));
  }
  auto* stream = new FilmStream(*context, executors_.files, controller_, request, films_);
  stream->guard(admission_, caller);
  return stream;
}

}  // namespace hyades::coordinator
