// Films of frames in work.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/access/caller.h"
#include "coordinator/controller/controller.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/service.h"
#include "core/base/mutex.h"
#include "core/film/film_codec.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// Films on their way at once, and with one token's name: each is in memory as a whole.
constexpr int kMostFilms = 4;
constexpr int kMostFilmsOfOne = 2;

/// How many films are on their way, and to whom. Thread-safe.
class OpenFilms {
 public:
  /// False where as many are as may be.
  bool open(const std::string& owner) HYADES_EXCLUDES(mutex_) {
    const core::MutexLock lock(mutex_);
    if (all_ >= kMostFilms || of_[owner] >= kMostFilmsOfOne) return false;
    ++all_;
    ++of_[owner];
    return true;
  }
  void close(const std::string& owner) HYADES_EXCLUDES(mutex_) {
    const core::MutexLock lock(mutex_);
    --all_;
    if (--of_[owner] == 0) of_.erase(owner);
  }

 private:
  core::Mutex mutex_;
  int all_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<std::string, int> of_ HYADES_GUARDED_BY(mutex_);
};

/// Sends what is rendered of a frame: what it is, then its bytes, in chunks.
class FilmStream final : public Producer<v1::FilmPart> {
 public:
  /// `films`: where this one is counted in already, for `owner`.
  FilmStream(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Controller& controller,
             v1::FilmRequest request, std::shared_ptr<OpenFilms> films, std::string owner)
      : Producer(context, pool),
        controller_(controller),
        request_(std::move(request)),
        films_(std::move(films)),
        owner_(std::move(owner)),
        found_(std::make_shared<Found>()) {}

  ~FilmStream() override { films_->close(owner_); }

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
        request_.job(), request_.frame(), owner_,
        [found = found_, waker = waker()](const grpc::Status& said, const core::FilmInfo& info,
                                          std::shared_ptr<const core::Film> film) {
          found->status = said;
          found->info = info;
          found->film = std::move(film);
          found->there = true;
          waker->wake();
        });
    if (asked.ok()) return;
    found_->status = asked;
    found_->there = true;
  }

  Step next(v1::FilmPart& part, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::needs_thread;
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
    const uint64_t count = std::min(kFilePieceBytes, bytes_.size() - offset_);
    part.mutable_chunk()->set_offset(offset_);
    part.mutable_chunk()->set_data(bytes_.data() + offset_, count);
    offset_ += count;
    return Step::message;
  }

  Controller& controller_;
  const v1::FilmRequest request_;
  const std::shared_ptr<OpenFilms> films_;
  const std::string owner_;
  const std::shared_ptr<Found> found_;
  bool asked_ = false;
  std::vector<std::byte> bytes_;
  uint64_t offset_ = 0;
};

}  // namespace

void add_film_stream(Service& service) {
  service.add_server_stream<v1::FilmRequest>(
      "Jobs/Film",
      [&service, films = std::make_shared<OpenFilms>()](
          Service::Context& context, const Caller& caller, v1::FilmRequest&& request,
          grpc::Status& refused) -> OutgoingStream* {
        const std::string owner = owner_of(caller).name;
        if (films->open(owner)) {
          return new FilmStream(context, service.pool_of("Jobs/Film"), service.backend().controller,
                                std::move(request), films, owner);
        }
        refused =
            farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                              "enough films are on their way already", std::chrono::seconds(2));
        return nullptr;
      });
}

}  // namespace hyades::coordinator
