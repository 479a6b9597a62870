#pragma once

#include <chrono>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coordinator/brain/brain.h"
#include "coordinator/services/desks.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Frames as they are now: of the film in mid-render, of a finished file afterwards. What was made
/// once is kept for all who ask, and made anew at most once a second.
class PicturesApi {
 public:
  PicturesApi(Brain& brain, Desks& desks)
      : brain_(brain), desks_(desks), gate_(std::make_shared<Gate>()) {}
  ~PicturesApi();
  PicturesApi(const PicturesApi&) = delete;
  PicturesApi& operator=(const PicturesApi&) = delete;
  void add_routes(Router& router);

  /// What is asked for.
  struct Asked {
    uint64_t job = 0;
    int32_t frame = 0;
    bool half = false;
    int width = 0;  ///< 0: as large as it is
    std::string layer = "beauty";

    auto operator<=>(const Asked&) const = default;
  };

 private:
  /// A picture as it was made.
  struct Made {
    uint64_t samples_done = 0;
    bool over = false;  ///< the frame was done
    std::chrono::steady_clock::time_point at;
    WebReply reply;
  };
  using Kept = std::list<std::pair<Asked, Made>>;
  /// Films come by threads that may outlive this.
  struct Gate {
    std::mutex mutex;
    bool open = true;
  };

  void answer_picture(const Asked& asked, const Answer& answer);
  void make(const Asked& asked);
  void make_of_film(const Asked& asked, const Brain::FrameNow& now);
  void make_of_file(const Asked& asked, const Brain::FrameNow& now);
  WebReply show(const Asked& asked, const Brain::FrameNow& now, const core::Image& image,
                bool exact) const;
  void done(const Asked& asked, const Brain::FrameNow& now, const WebReply& reply);
  bool is_fresh(const Made& made, const Brain::FrameNow& now) const;

  Brain& brain_;
  Desks& desks_;
  const std::shared_ptr<Gate> gate_;
  std::mutex mutex_;
  Kept kept_;  ///< what was asked for last is in front
  std::map<Asked, Kept::iterator> index_;
  size_t kept_bytes_ = 0;
  std::map<Asked, std::vector<Answer>> waiting_;  ///< for what is being made
};

}  // namespace hyades::coordinator
