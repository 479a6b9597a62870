#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"
#include "farm/fair_shares.h"

namespace hyades::coordinator {

/// A picture that somebody asks for.
struct AskedPicture {
  uint64_t job = 0;
  int32_t frame = 0;
  bool half = false;
  bool mask = false;  ///< of the pixels that have samples, with `half`
  int width = 0;      ///< 0: as large as it is
  std::string layer = "beauty";

  auto operator<=>(const AskedPicture&) const = default;
};

/// Who waits for a picture.
struct PictureAsker {
  farm::ByteBudget::Owner owner;  ///< whom its bytes are counted for
  Answer answer;
};
using PictureAskers = std::vector<PictureAsker>;

/// The pictures that are wanted of a frame, and who waits for them.
using WantedPictures = std::map<AskedPicture, PictureAskers>;

/// Who waits for pictures of which frames, and whose turn it is. A frame's turn makes all that is
/// asked of it. Two frames are in work at a time, for different callers. The next turn is his for
/// whom least time was spent lately. Within a turn those who want pictures of the frame share it:
/// the next picture is his for whom least of the turn was spent. A turn ends between two pictures
/// once it has lasted for long, and somebody waits for whom less was spent. A frame for which there
/// is no memory beside the other one has its next turn alone. Makes nothing itself. Thread-safe.
class PictureTurns {
 public:
  using JobAndFrame = std::pair<uint64_t, int32_t>;

  /// Different pictures of one frame that wait, and of those that one caller waits for.
  static constexpr size_t kMostOfFrame = 32;
  static constexpr size_t kMostOfFrameOfOne = 8;
  /// How often one caller may wait for the same pictures of a frame.
  static constexpr int kMostAskersOfOne = 64;

  /// `longest`: after which another's turn begins, once a picture is made.
  explicit PictureTurns(std::chrono::milliseconds longest) : longest_(longest) {}

  /// The picture waits for a turn of its frame, which comes by whoever asks for the frame: others
  /// may have asked first, and for very many. False where too many frames wait, or too many
  /// pictures of this one.
  bool add(const AskedPicture& asked, const PictureAsker& asker) HYADES_EXCLUDES(mutex_);

  /// The frame whose turn begins now; none: as many are in work as may be, or their callers'.
  std::optional<JobAndFrame> begin_next() HYADES_EXCLUDES(mutex_);
  /// Whether nothing else is begun beside the frame in work.
  bool is_alone(JobAndFrame id) HYADES_EXCLUDES(mutex_);
  /// What is wanted of the frame in work by now; what is asked for from now on comes after it.
  WantedPictures take_wanted(JobAndFrame id) HYADES_EXCLUDES(mutex_);
  /// What is made next in the frame's turn of what is wanted, which is not empty: for whom least
  /// was spent.
  WantedPictures::iterator next_of(JobAndFrame id, WantedPictures& wanted) HYADES_EXCLUDES(mutex_);
  /// What the turn has taken since the last charge was for a picture, for one of those who have
  /// asked for it.
  void charge(JobAndFrame id, const PictureAskers& askers) HYADES_EXCLUDES(mutex_);
  /// Whether the frame's turn ends before what is next of `wanted`: it has lasted for long, and
  /// somebody waits for whom less time was spent: in this turn, where he waits for the same frame,
  /// lately in all, where for one that might begin if this turn was over.
  bool gives_way(JobAndFrame id, WantedPictures& wanted) HYADES_EXCLUDES(mutex_);
  /// The frame's turn is over. For what is `left` of it, or was not taken, there is another one:
  /// alone where there was `no_room`.
  void end(JobAndFrame id, const WantedPictures& left, bool no_room) HYADES_EXCLUDES(mutex_);

 private:
  using Clock = std::chrono::steady_clock;
  /// A frame in work.
  struct FrameTurn {
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

  bool may_wait(const std::string& owner) const HYADES_REQUIRES(mutex_);
  static bool may_want(const WantedPictures& wanted, const AskedPicture& asked,
                       const std::string& owner);
  void line_up(JobAndFrame id, const std::string& owner) HYADES_REQUIRES(mutex_);
  bool has_turn(const std::string& owner, JobAndFrame id) const HYADES_REQUIRES(mutex_);
  Spent spent_for(const std::string& who, const FrameTurn& turn, Clock::time_point now) const
      HYADES_REQUIRES(mutex_);
  const std::string& payer_of(const PictureAskers& askers, const FrameTurn& turn,
                              Clock::time_point now) const HYADES_REQUIRES(mutex_);
  WantedPictures::iterator next_in(const FrameTurn& turn, WantedPictures& wanted,
                                   Clock::time_point now) const HYADES_REQUIRES(mutex_);
  void charge_locked(JobAndFrame id, const std::string& whom) HYADES_REQUIRES(mutex_);
  void put_back(JobAndFrame id, const WantedPictures& left) HYADES_REQUIRES(mutex_);
  static std::set<std::string> owners_of(const WantedPictures& wanted);

  const std::chrono::milliseconds longest_;
  core::Mutex mutex_;
  std::map<JobAndFrame, WantedPictures> wanted_ HYADES_GUARDED_BY(mutex_);
  /// Frames of wanted_, once for each who waits for pictures of them: those in work, too, until
  /// they take what is wanted.
  std::deque<std::pair<JobAndFrame, std::string>> queue_ HYADES_GUARDED_BY(mutex_);
  /// Those of them for which there was no memory beside another: nothing else is begun beside them.
  std::set<JobAndFrame> alone_ HYADES_GUARDED_BY(mutex_);
  /// Those whose films or files are being read or shown.
  std::map<JobAndFrame, FrameTurn> in_work_ HYADES_GUARDED_BY(mutex_);
  farm::FairShares shares_ HYADES_GUARDED_BY(mutex_);  ///< seconds of turns, of callers
};

}  // namespace hyades::coordinator
