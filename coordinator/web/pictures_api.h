#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "coordinator/controller/controller.h"
#include "coordinator/web/kept_pictures.h"
#include "coordinator/web/picture_turns.h"
#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"
#include "farm/thread_pool.h"

namespace hyades::coordinator {

/// Frames as they are now: of the film in mid-render, of a finished file afterwards. What was made
/// once is kept for all who ask. What is asked of a frame is made in turns (PictureTurns), of one
/// copy of its film at most once a second. Pictures that somebody takes his time to read count
/// until he has them, and where they are too many no more are made.
class PicturesApi {
 public:
  static constexpr std::chrono::milliseconds kLongestTurn{2000};

  /// `held` counts the bytes of the pictures. What is begun with goes a picture beyond it for each
  /// thread. `longest_turn`: after which another's begins, once a picture is made.
  explicit PicturesApi(Controller& controller,
                       std::shared_ptr<farm::ByteBudget> held = std::make_shared<farm::ByteBudget>(
                           KeptPictures::kMostBytes, KeptPictures::kMostBytesOfOne),
                       std::chrono::milliseconds longest_turn = kLongestTurn)
      : controller_(controller),
        gate_(std::make_shared<Gate>()),
        kept_(std::move(held)),
        turns_(longest_turn) {}
  PicturesApi(const PicturesApi&) = delete;
  PicturesApi& operator=(const PicturesApi&) = delete;

  void add_routes(Router& router);
  /// Makes no more pictures, but for those that are being made. To be called before the destructor,
  /// which waits for the threads that make them.
  void close();

 private:
  /// Makes a picture. RESOURCE_EXHAUSTED where there is no memory for it, and for nothing else.
  using Make = std::function<grpc::Status(const AskedPicture&, WebReply&)>;
  using JobAndFrame = PictureTurns::JobAndFrame;
  /// Films come by threads that may outlive this.
  struct Gate {
    core::Mutex mutex;
    bool open HYADES_GUARDED_BY(mutex) = true;
  };

  void answer_picture(const AskedPicture& asked, const PictureAsker& asker);
  core::Result<std::optional<StoredOutput>> best_file(const AskedPicture& asked);
  struct OpenFile;
  grpc::Status of_file(const AskedPicture& asked, const FrameNow& now,
                       std::optional<OpenFile>& open, WebReply& reply);
  bool is_closed() const;
  void begin_some();
  void take(JobAndFrame id);
  void take_film(JobAndFrame id, const FrameNow& now);
  void take_files(JobAndFrame id, const FrameNow& now);
  void make_all(JobAndFrame id, const FrameNow& now, const grpc::Status& found,
                std::shared_ptr<const core::Film> film);
  void make_wanted(JobAndFrame id, Make make);
  bool make_one(const AskedPicture& asked, const PictureAskers& askers, const Make& make,
                WebReply& reply);
  void end(JobAndFrame id, const WebReply& reply);
  void leave(JobAndFrame id, const WantedPictures& left, bool no_room);

  Controller& controller_;
  const std::shared_ptr<Gate> gate_;
  KeptPictures kept_;
  PictureTurns turns_;
  farm::ThreadPool pool_{2, 1000, 1};  ///< ends first: its threads use all of the above
};

}  // namespace hyades::coordinator
