#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <list>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/display/viewer_link.h"
#include "core/base/mutex.h"
#include "core/image/image.h"

namespace hyades::cli {

/// Shows pictures in a viewer that speaks tev's protocol (packets.h), from a thread of its own that
/// nobody waits for. It holds each picture as it is now, and sends the parts that have changed
/// since it sent them last; what changes faster than the viewer reads is skipped. A viewer that
/// comes later, or again, gets the pictures as they are then. Thread-safe.
class Viewer {
 public:
  /// Pictures that are held; for another one the one that did not change for longest goes, and
  /// stays in the viewer as it is.
  static constexpr size_t kMostHeld = 4;
  /// Pictures that are left in the viewer; for another one the oldest is closed there.
  static constexpr size_t kMostShown = 24;
  /// Edge of the parts that are sent, pixels.
  static constexpr int kPart = 64;

  /// `address`: HOST:PORT, as check_address() lets pass.
  explicit Viewer(const std::string& address);
  /// Sends what is left, as long as the viewer takes it: two seconds at most.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Puts `part` at (x, y) into picture `name`, which begins black. All parts of a picture have the
  /// same channels and lie within its size.
  void put(const std::string& name, int width, int height, const core::Image& part, int x, int y)
      HYADES_EXCLUDES(mutex_);

  /// Why nothing is shown; told once.
  std::optional<std::string> take_notice() HYADES_EXCLUDES(mutex_);

 private:
  using Clock = std::chrono::steady_clock;
  struct Picture {
    std::string name;
    core::Image image;
    std::vector<bool> changed;  ///< parts that are to be sent, row by row
    size_t changes = 0;         ///< how many
    size_t next = 0;            ///< where the search for one goes on
    bool created = false;       ///< the viewer has it

    int columns() const { return (image.width + kPart - 1) / kPart; }
    void mark(size_t part);
  };
  Picture& hold(const std::string& name, int width, int height, const core::Image& part)
      HYADES_REQUIRES(mutex_);
  void run() HYADES_EXCLUDES(mutex_);
  bool ends_within(Clock::duration wait) HYADES_REQUIRES(mutex_);
  bool connect() HYADES_REQUIRES(mutex_);
  bool send_something() HYADES_REQUIRES(mutex_);
  bool has_news() const HYADES_REQUIRES(mutex_);
  bool must_give_up() const HYADES_EXCLUDES(mutex_);
  void lose() HYADES_REQUIRES(mutex_);
  static std::string next_part(Picture& picture);

  const std::string address_;
  ViewerLink link_;  ///< of the thread

  mutable core::Mutex mutex_;
  core::CondVar wake_;
  std::list<Picture> pictures_ HYADES_GUARDED_BY(mutex_);    ///< those sent last are the last
  std::deque<std::string> shown_ HYADES_GUARDED_BY(mutex_);  ///< in the viewer, the oldest first
  std::deque<std::string> to_close_ HYADES_GUARDED_BY(mutex_);
  std::optional<std::string> notice_ HYADES_GUARDED_BY(mutex_);
  bool noticed_ HYADES_GUARDED_BY(mutex_) = false;
  bool connected_ HYADES_GUARDED_BY(mutex_) = false;
  /// It ends, at this time for certain.
  std::optional<Clock::time_point> last_words_ HYADES_GUARDED_BY(mutex_);
  std::thread thread_;
};

}  // namespace hyades::cli
