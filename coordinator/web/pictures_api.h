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
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"
#include "farm/fair_shares.h"
#include "farm/thread_pool.h"

namespace hyades::coordinator {

/// Frames as they are now: of the film in mid-render, of a finished file afterwards. What was made
/// once is kept for all who ask. What is asked of a frame is made together, of one copy of its film
/// at most once a second, and of two frames at a time, for different callers: next is for whom
/// lately least time was spent. Those who want pictures of the same frame share its turn: next is
/// for whom least of it was spent. It ends between two pictures once it has lasted for long, and
/// somebody waits for whom less was spent. A frame for which there is no memory beside the other
/// one has its next turn alone. Pictures that somebody takes his time to read count until he has
/// them, and where they are too many no more are made.
class PicturesApi {
 public:
  /// Of all pictures together, kept or on their way, and of those that were made for one caller.
  static constexpr uint64_t kMostBytes = uint64_t{512} << 20U;
  static constexpr uint64_t kMostBytesOfOne = kMostBytes / 2;
  /// Different ones of one frame that wait, and of those that one caller waits for.
  static constexpr size_t kMostOfFrame = 32;
  static constexpr size_t kMostOfFrameOfOne = 8;

  static constexpr std::chrono::milliseconds kLongestTurn{2000};

  /// `held` counts the bytes of the pictures. What is begun with goes a picture beyond it for each
  /// thread. `longest_turn`: after which another's begins, once a picture is made.
  explicit PicturesApi(Controller& controller,
                       std::shared_ptr<farm::ByteBudget> held =
                           std::make_shared<farm::ByteBudget>(kMostBytes, kMostBytesOfOne),
                       std::chrono::milliseconds longest_turn = kLongestTurn)
      : controller_(controller),
        gate_(std::make_shared<Gate>()),
        held_(std::move(held)),
        longest_turn_(longest_turn) {}
  PicturesApi(const PicturesApi&) = delete;
  PicturesApi& operator=(const PicturesApi&) = delete;

  void add_routes(Router& router);
  /// Makes no more pictures, but for those that are being made. To be called before the destructor,
  /// which waits for the threads that make them.
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
    std::string owner;  ///< whom its bytes are counted for
  };
  using Kept = std::list<std::pair<Asked, Made>>;
  /// Who waits for a picture.
  struct Asker {
    farm::ByteBudget::Owner owner;  ///< whom its bytes are counted for
    Answer answer;
  };
  using Askers = std::vector<Asker>;
  /// Makes a picture, and counts its bytes for the owner. RESOURCE_EXHAUSTED where there is no
  /// memory for it, and for nothing else.
  using Make = std::function<grpc::Status(const Asked&, const farm::ByteBudget::Owner&, WebReply&)>;
  /// The pictures that are wanted of a frame, and who waits for them.
  using Wanted = std::map<Asked, Askers>;
  using JobAndFrame = std::pair<uint64_t, int32_t>;
  /// A frame in work.
  struct Turn {
    std::string owner;  ///< by whom its turn has come
    Clock::time_point begun;
    Clock::time_point charged;  ///< until when its time is counted
    bool alone = false;         ///< nothing else is begun beside it
    farm::FairShares spent;     ///< seconds of it, for callers
  };
  /// Seconds that were spent for somebody; compared in this order.
  struct Spent {
    double in_turn = 0;
    double lately = 0;

    auto operator<=>(const Spent&) const = default;
  };
  /// Films come by threads that may outlive this.
  struct Gate {
    core::Mutex mutex;
    bool open HYADES_GUARDED_BY(mutex) = true;
  };

  void answer_picture(const Asked& asked, const Asker& asker);
  core::Result<std::optional<StoredOutput>> best_file(const Asked& asked);
  struct OpenFile;
  grpc::Status of_file(const Asked& asked, const farm::ByteBudget::Owner& owner,
                       const FrameNow& now, std::optional<OpenFile>& open, WebReply& reply);
  bool is_closed() const;
  bool enqueue(const Asked& asked, const Asker& asker);
  bool may_wait(const std::string& owner) const HYADES_REQUIRES(mutex_);
  bool has_turn(const std::string& owner, JobAndFrame id) const HYADES_REQUIRES(mutex_);
  void line_up(JobAndFrame id, const std::string& owner) HYADES_REQUIRES(mutex_);
  std::optional<JobAndFrame> begin_next() HYADES_EXCLUDES(mutex_);
  static bool may_want(const Wanted& wanted, const Asked& asked, const std::string& owner);
  void begin_some();
  void take(JobAndFrame id);
  void take_film(JobAndFrame id, const FrameNow& now);
  void take_files(JobAndFrame id, const FrameNow& now);
  Wanted take_wanted(JobAndFrame id) HYADES_EXCLUDES(mutex_);
  void make_all(JobAndFrame id, const FrameNow& now, const grpc::Status& found,
                std::shared_ptr<const core::Film> film);
  void make_wanted(JobAndFrame id, Make make);
  bool make_one(const Asked& asked, const Askers& askers, const Make& make, WebReply& reply);
  Spent spent_for(const std::string& who, const Turn& turn, Clock::time_point now) const
      HYADES_REQUIRES(mutex_);
  const std::string& payer_of(const Askers& askers, const Turn& turn, Clock::time_point now) const
      HYADES_REQUIRES(mutex_);
  Wanted::iterator next_of(JobAndFrame id, Wanted& wanted) HYADES_EXCLUDES(mutex_);
  Wanted::iterator next_in(const Turn& turn, Wanted& wanted, Clock::time_point now) const
      HYADES_REQUIRES(mutex_);
  Turn turn_of(JobAndFrame id) HYADES_EXCLUDES(mutex_);
  void charge(JobAndFrame id, const Askers& askers) HYADES_EXCLUDES(mutex_);
  void charge_locked(JobAndFrame id, const std::string& whom) HYADES_REQUIRES(mutex_);
  bool gives_way(JobAndFrame id, Wanted& wanted) HYADES_EXCLUDES(mutex_);
  void end(JobAndFrame id, const WebReply& reply);
  void leave(JobAndFrame id, const Wanted& left, bool no_room) HYADES_EXCLUDES(mutex_);
  void put_back(JobAndFrame id, const Wanted& left) HYADES_REQUIRES(mutex_);
  static std::set<std::string> owners_of(const Wanted& wanted);
  bool has_room(const farm::ByteBudget::Owner& owner);
  void count(WebReply& reply, const farm::ByteBudget::Owner& owner) const;
  std::optional<WebReply> find(const Asked& asked, const std::string& tag, bool over);
  void keep(const Asked& asked, const std::string& tag, bool over, const WebReply& reply,
            const farm::ByteBudget::Owner& owner);
  void forget(Kept::iterator one) HYADES_REQUIRES(mutex_);

  Controller& controller_;
  const std::shared_ptr<Gate> gate_;
  const std::shared_ptr<farm::ByteBudget>
      held_;  ///< connections may hold pictures for longer than this
  const std::chrono::milliseconds longest_turn_;
  core::Mutex mutex_;
  Kept kept_ HYADES_GUARDED_BY(mutex_);  ///< what was asked for last is in front
  std::map<Asked, Kept::iterator> index_ HYADES_GUARDED_BY(mutex_);
  size_t kept_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<JobAndFrame, Wanted> wanted_ HYADES_GUARDED_BY(mutex_);
  /// Frames of wanted_, once for each who waits for pictures of them: those in work, too, until
  /// they take what is wanted.
  std::deque<std::pair<JobAndFrame, std::string>> queue_ HYADES_GUARDED_BY(mutex_);
  /// Those of them for which there was no memory beside another: nothing else is begun beside them.
  std::set<JobAndFrame> alone_ HYADES_GUARDED_BY(mutex_);
  /// Those whose films or files are being read or shown.
  std::map<JobAndFrame, Turn> in_work_ HYADES_GUARDED_BY(mutex_);
  farm::FairShares shares_ HYADES_GUARDED_BY(mutex_);  ///< seconds of turns, of callers
  farm::ThreadPool pool_{2, 1000, 1};  ///< ends first: its threads use all of the above
};

}  // namespace hyades::coordinator
