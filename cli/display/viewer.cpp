#include "cli/display/viewer.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "cli/display/packets.h"
#include "farm/backoff.h"

namespace hyades::cli {
namespace {

constexpr auto kLastWords = std::chrono::seconds(2);
/// Between two rounds over what has changed: more often nobody sees.
constexpr auto kRound = std::chrono::milliseconds(100);
constexpr auto kFirstTry = std::chrono::milliseconds(250);
constexpr auto kLongestTry = std::chrono::seconds(5);
constexpr int kNice = 10;

}  // namespace

void Viewer::Picture::mark(size_t part) {
  if (changed[part]) return;
  changed[part] = true;
  ++changes;
}

Viewer::Viewer(const std::string& address)
    : address_(address), link_(core::split_address(address), [this] { return must_give_up(); }) {
  thread_ = std::thread([this] { run(); });
}

Viewer::~Viewer() {
  {
    const core::MutexLock lock(mutex_);
    last_words_ = Clock::now() + kLastWords;
  }
  wake_.notify_one();
  thread_.join();
}

bool Viewer::must_give_up() const {
  const core::MutexLock lock(mutex_);
  return last_words_ && Clock::now() >= *last_words_;
}

std::optional<std::string> Viewer::take_notice() {
  const core::MutexLock lock(mutex_);
  return std::exchange(notice_, std::nullopt);
}

Viewer::Picture& Viewer::hold(const std::string& name, int width, int height,
                              const core::Image& part) {
  const auto known = std::find_if(pictures_.begin(), pictures_.end(),
                                  [&](const Picture& picture) { return picture.name == name; });
  if (known != pictures_.end()) {
    const core::Image& image = known->image;
    if (image.width == width && image.height == height && image.channels == part.channels)
      return *known;
    pictures_.erase(known);
  }
  if (pictures_.size() >= kMostHeld) {
    // Rather one that is in the viewer as it should be.
    const auto sent = std::find_if(pictures_.begin(), pictures_.end(),
                                   [](const Picture& picture) { return picture.changes == 0; });
    pictures_.erase(sent != pictures_.end() ? sent : pictures_.begin());
  }
  Picture& picture = pictures_.emplace_back();
  picture.name = name;
  picture.image = core::make_image(width, height, part.channels);
  const int rows = (height + kPart - 1) / kPart;
  picture.changed.resize(static_cast<size_t>(picture.columns()) * static_cast<size_t>(rows));
  return picture;
}

void Viewer::put(const std::string& name, int width, int height, const core::Image& part, int x,
                 int y) {
  const core::MutexLock lock(mutex_);
  Picture& picture = hold(name, width, height, part);
  const size_t channels = part.channels.size();
  for (int row = 0; row < part.height; ++row) {
    // Cut at the borders of the parts that are sent, so that those that stay the same are not.
    for (int column = 0; column < part.width;) {
      const int end = std::min(part.width, ((x + column) / kPart + 1) * kPart - x);
      const float* const from = part.data.data() + part.index(column, row, 0);
      float* const to = picture.image.data.data() + picture.image.index(x + column, y + row, 0);
      const size_t bytes = static_cast<size_t>(end - column) * channels * sizeof(float);
      if (std::memcmp(from, to, bytes) != 0) {
        std::memcpy(to, from, bytes);
        picture.mark(static_cast<size_t>((y + row) / kPart) *
                         static_cast<size_t>(picture.columns()) +
                     static_cast<size_t>((x + column) / kPart));
      }
      column = end;
    }
  }
}

bool Viewer::has_news() const {
  return !to_close_.empty() ||
         std::any_of(pictures_.begin(), pictures_.end(), [](const Picture& picture) {
           return !picture.created || picture.changes > 0;
         });
}

/// The viewer is gone, and with it all that it had.
void Viewer::lose() {
  connected_ = false;
  shown_.clear();
  to_close_.clear();
  for (Picture& picture : pictures_) {
    picture.created = false;
    for (size_t part = 0; part < picture.changed.size(); ++part) picture.mark(part);
  }
}

/// Waits so long for the end; whether it has come.
bool Viewer::ends_within(Clock::duration wait) {
  const Clock::time_point until = Clock::now() + wait;
  while (!last_words_ && Clock::now() < until) wake_.wait_until(mutex_, until);
  return last_words_.has_value();
}

bool Viewer::connect() {
  mutex_.unlock();
  const core::Status opened = link_.open();
  mutex_.lock();
  connected_ = opened.ok();
  if (!connected_ && !std::exchange(noticed_, true)) {
    notice_ = fmt::format("no viewer at {} ({}): the picture is shown there when one comes",
                          address_, opened.error().message);
  }
  return connected_;
}

std::string Viewer::next_part(Picture& picture) {
  while (!picture.changed[picture.next % picture.changed.size()]) ++picture.next;
  const auto part = static_cast<int>(picture.next++ % picture.changed.size());
  picture.changed[static_cast<size_t>(part)] = false;
  --picture.changes;
  const int x = part % picture.columns() * kPart;
  const int y = part / picture.columns() * kPart;
  const core::PixelRect rect{x, y, std::min(x + kPart, picture.image.width),
                             std::min(y + kPart, picture.image.height)};
  const core::Image cut =
      core::cut_out(picture.image, rect.x0, rect.y0, rect.width(), rect.height());
  return update_picture(picture.name, rect, cut.channels, cut.data);
}

/// Sends one packet of what is new; false where the viewer did not take it.
bool Viewer::send_something() {
  std::string packet;
  if (!to_close_.empty()) {
    packet = close_picture(to_close_.front());
    to_close_.pop_front();
  } else {
    const auto news = std::find_if(pictures_.begin(), pictures_.end(), [](const Picture& picture) {
      return !picture.created || picture.changes > 0;
    });
    if (news == pictures_.end()) return true;
    if (news->created) {
      packet = next_part(*news);
    } else {
      news->created = true;
      packet = create_picture(news->name, true, news->image.width, news->image.height,
                              news->image.channels);
      std::erase(shown_, news->name);
      shown_.push_back(news->name);
      if (shown_.size() > kMostShown) {
        to_close_.push_back(shown_.front());
        shown_.pop_front();
      }
    }
    // The others have their turn too.
    pictures_.splice(pictures_.end(), pictures_, news);
  }
  mutex_.unlock();
  const bool sent = link_.send(packet);
  mutex_.lock();
  return sent;
}

void Viewer::run() {
  // Rendering goes first. On Linux this is of the calling thread alone; where it is refused, fine.
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNice));
  farm::Backoff backoff(kFirstTry, kLongestTry);
  const core::MutexLock lock(mutex_);
  while (connected_ || connect() || !ends_within(backoff.next())) {
    while (connected_ && has_news()) {
      if (!send_something()) lose();
    }
    if (last_words_) return;
    if (connected_) {
      ends_within(kRound);
      if (link_.is_open()) {
        backoff.reset();
      } else {
        lose();
      }
    }
    // One that goes as soon as it has come is no viewer.
    if (!connected_ && ends_within(backoff.next())) return;
  }
}

}  // namespace hyades::cli
