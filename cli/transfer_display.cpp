#include "cli/transfer_display.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/duration.h"
#include "core/base/text.h"

namespace hyades::cli {
using core::seconds;

namespace {

/// The rate is that of so long a time, looked at so often.
constexpr auto kLately = std::chrono::seconds(10);
constexpr auto kLook = std::chrono::milliseconds(250);

}  // namespace

std::string transfer_line(const Transfer& transfer, bool bar) {
  std::string line = transfer.what;
  const uint64_t moved =
      transfer.total > 0 ? std::min(transfer.moved, transfer.total) : transfer.moved;
  if (transfer.total > 0) {
    const double share = static_cast<double>(moved) / static_cast<double>(transfer.total);
    if (bar) line += "  " + progress_bar(share);
    line += fmt::format("  {:3.0f} %", 100.0 * share);
  }
  if (!transfer.file.empty()) line += "  file " + transfer.file;
  line += "  " + core::format_bytes(moved);
  if (transfer.total > 0) line += " of " + core::format_bytes(transfer.total);
  if (transfer.bytes_per_second > 0) {
    line +=
        fmt::format("  {}/s", core::format_bytes(static_cast<uint64_t>(transfer.bytes_per_second)));
    if (transfer.total > 0) {
      const double left = static_cast<double>(transfer.total - moved) / transfer.bytes_per_second;
      line += "  " + core::format_time_left(left) + " left";
    }
  }
  return line;
}

TransferDisplay::TransferDisplay(std::string what, bool quiet,
                                 std::function<Clock::time_point()> now)
    : quiet_(quiet), now_(std::move(now)), line_(now_) {
  transfer_.what = std::move(what);
  lately_.emplace_back(now_(), 0);
}

void TransferDisplay::note_rate(Clock::time_point now) {
  if (now - lately_.back().first >= kLook) lately_.emplace_back(now, transfer_.moved);
  while (lately_.size() > 2 && now - lately_[1].first >= kLately) lately_.pop_front();
  const auto& [since, before] = lately_.front();
  const double time = seconds(now - since);
  if (time >= seconds(kLook)) {
    transfer_.bytes_per_second = static_cast<double>(transfer_.moved - before) / time;
  }
}

void TransferDisplay::moved(uint64_t bytes) {
  transfer_.moved += bytes;
  const Clock::time_point now = now_();
  note_rate(now);
  if (quiet_) return;
  if (line_.is_due()) line_.show(transfer_line(transfer_, line_.redraws()));
}

}  // namespace hyades::cli
