#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "coordinator/web/picture_turns.h"
#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"

namespace hyades::coordinator {

/// Pictures that were made, for all who ask for them again, and the bytes of those that are on
/// their way. Thread-safe.
class KeptPictures {
 public:
  /// Bytes that are on their way to all readers together, and to one; what several get counts for
  /// each.
  static constexpr uint64_t kMostBytes = uint64_t{384} << 20U;
  static constexpr uint64_t kMostBytesOfOne = kMostBytes / 2;

  /// `held` counts the bytes on their way: connections may hold pictures for longer than this.
  explicit KeptPictures(std::shared_ptr<farm::ByteBudget> held) : held_(std::move(held)) {}

  /// The picture, if it is still what `tag` names: the ETag of the frame's film where the frame is
  /// in work, and of the file that shows it best where it is `over`. One of a frame in work is good
  /// for a second, however many samples have come.
  std::optional<WebReply> find(const AskedPicture& asked, const std::string& tag, bool over);

  /// Keeps the picture in `reply`, if it is one and no error.
  void keep(const AskedPicture& asked, const std::string& tag, bool over, const WebReply& reply);

  /// Whether one more may be on its way to the reader: how large it becomes is not known before.
  bool has_room(const farm::ByteBudget::Owner& reader) const { return held_->has_room(reader, 1); }
  /// `reply` for the reader, for whom its bytes count as long as anybody holds it, a connection
  /// that does not read, say; or, where he has no room for it, `refused`.
  WebReply reply_for(const farm::ByteBudget::Owner& reader, WebReply reply,
                     const WebReply& refused) const;

 private:
  using Clock = std::chrono::steady_clock;
  /// A picture as it was made.
  struct Made {
    std::string tag;  ///< the picture's ETag: the same as long as it would be the same
    bool over = false;
    Clock::time_point at;
    WebReply reply;
  };
  using Kept = std::list<std::pair<AskedPicture, Made>>;

  void forget(Kept::iterator one) HYADES_REQUIRES(mutex_);

  const std::shared_ptr<farm::ByteBudget> held_;
  core::Mutex mutex_;
  Kept kept_ HYADES_GUARDED_BY(mutex_);  ///< what was asked for last is in front
  std::map<AskedPicture, Kept::iterator> index_ HYADES_GUARDED_BY(mutex_);
  size_t kept_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
};

}  // namespace hyades::coordinator
