#include "coordinator/controller/log_buffer.h"

#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostLinesWaiting = 2000;

}  // namespace

void LogBuffer::add(StoredLine line) {
  if (lines_.size() < kMostLinesWaiting) {
    lines_.push_back(std::move(line));
  } else {
    ++dropped_;
  }
}

bool LogBuffer::begin_storing(TimePoint now) {
  if (lines_.empty() || storing_ || now < again_) return false;
  storing_ = true;
  return true;
}

std::vector<StoredLine> LogBuffer::take() {
  std::vector<StoredLine> taken = std::exchange(lines_, {});
  if (const uint64_t dropped = std::exchange(dropped_, 0); dropped > 0) {
    taken.push_back({taken.back().time_ms, v1::LOG_LEVEL_WARNING, std::nullopt, "",
                     core::counted(dropped, "line") + (dropped == 1 ? " was" : " were") +
                         " dropped: too many at once"});
  }
  return taken;
}

void LogBuffer::not_stored(std::vector<StoredLine> taken, TimePoint again) {
  storing_ = false;
  again_ = again;
  taken.insert(taken.end(), std::make_move_iterator(lines_.begin()),
               std::make_move_iterator(lines_.end()));
  lines_ = std::move(taken);
  if (lines_.size() <= kMostLinesWaiting) return;
  const size_t over = lines_.size() - kMostLinesWaiting;
  lines_.erase(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(over));
  dropped_ += over;
}

}  // namespace hyades::coordinator
