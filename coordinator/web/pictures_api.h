#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/thread_pool.h"

namespace hyades::coordinator {

/// Frames as they are now: of the film in mid-render, of a finished file afterwards. What was made
/// once is kept for all who ask. A film is copied for all that is asked of its frame together, at
/// most once a second, and two films at a time, whoever asks for how many.
class PicturesApi {
 public:
  explicit PicturesApi(Controller& controller)
      : controller_(controller), gate_(std::make_shared<Gate>()) {}
  PicturesApi(const PicturesApi&) = delete;
  PicturesApi& operator=(const PicturesApi&) = delete;

  void add_routes(Router& router);
  /// Drops the films that come from now on. To be called before the destructor, which waits for the
  /// threads that make pictures.
  void close();

  /// A picture that somebody asks for.
  struct Asked {
    uint64_t job = 0;
    int32_t frame = 0;
    bool half = false;
    bool mask = false;  ///< of the pixels that have samples, with `half`
    int width = 0;      ///< 0: as large as it is
    std::string layer = "beauty";

    auto operator<=>(const Asked&) const = default;
  };

 private:
  using Clock = std::chrono::steady_clock;
  /// A picture as it was made.
  struct Made {
    std::string tag;  ///< the picture's ETag: the same as long as it would be the same
    bool over = false;
    Clock::time_point at;
    WebReply reply;
  };
  using Kept = std::list<std::pair<Asked, Made>>;
  /// The pictures that are wanted of a frame in work, and who waits for them.
  using Wanted = std::map<Asked, std::vector<Answer>>;
  using FrameId = std::pair<uint64_t, int32_t>;
  /// Films come by threads that may outlive this.
  struct Gate {
    core::Mutex mutex;
    bool open HYADES_GUARDED_BY(mutex) = true;
  };

  void answer_picture(const Asked& asked, const Answer& answer);
  WebReply of_file(const Asked& asked, const FrameNow& now);
  void want(const Asked& asked, const Answer& answer);
  bool enqueue(const Asked& asked, const Answer& answer);
  void begin_some();
  void take_film(FrameId id);
  void make_all(FrameId id, const FrameNow& now, const grpc::Status& found, const core::Film* film);
  void end(FrameId id, const std::function<WebReply(const Asked&)>& reply);
  std::optional<WebReply> find(const Asked& asked, const std::string& tag, bool over);
  void keep(const Asked& asked, const std::string& tag, bool over, const WebReply& reply);

  Controller& controller_;
  const std::shared_ptr<Gate> gate_;
  core::Mutex mutex_;
  Kept kept_ HYADES_GUARDED_BY(mutex_);  ///< what was asked for last is in front
  std::map<Asked, Kept::iterator> index_ HYADES_GUARDED_BY(mutex_);
  size_t kept_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<FrameId, Wanted> wanted_ HYADES_GUARDED_BY(mutex_);
  std::deque<FrameId> queue_
      HYADES_GUARDED_BY(mutex_);             ///< of frames whose films nobody fetches yet
  int films_ HYADES_GUARDED_BY(mutex_) = 0;  ///< that are being fetched or shown
  farm::ThreadPool pool_{2, 1000};           ///< ends first: its threads use all of the above
};

}  // namespace hyades::coordinator
