#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace hyades::coordinator {

/// The row of the database that tells who leads.
struct LeaseRow {
  uint64_t incarnation = 0;          ///< of the leader; 0: nobody has ever led
  uint64_t renewed = 0;              ///< how often the leader has said that it is there
  std::string holder{};              ///< the leader, for people; empty: it has stepped down
  std::string url{};                 ///< of its dashboard; empty: it has none, or not yet
  std::chrono::milliseconds time{};  ///< without a renewal, after which it is gone
};

/// Decides for a stand-by whether the leader is gone: by how long its row stays the same on this
/// process' own clock. No clock of another machine counts, so that none that is wrong or jumps does
/// harm. Pure.
class LeaderWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Takes in how the row is at `now`, times that never go back. Whether to take over.
  bool is_gone(const LeaseRow& row, TimePoint now) {
    if (!since_ || row.incarnation != incarnation_ || row.renewed != renewed_) {
      since_ = now;
      incarnation_ = row.incarnation;
      renewed_ = row.renewed;
    }
    return row.holder.empty() || now - *since_ >= row.time;
  }

 private:
  std::optional<TimePoint> since_;  ///< when it was first seen as it is
  uint64_t incarnation_ = 0;
  uint64_t renewed_ = 0;
};

}  // namespace hyades::coordinator
