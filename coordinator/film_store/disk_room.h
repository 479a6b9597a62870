#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// a - b; 0 where b is larger.
constexpr uint64_t surplus(uint64_t a, uint64_t b) { return a > b ? a - b : 0; }

/// The bytes of `room` that one owner's upload may have beside what all uploads are expected to
/// bring, by their owners: his own count, of each other's at most half of what is left then, so
/// that nobody takes all by announcing it.
uint64_t room_beside(uint64_t room, const std::map<std::string, uint64_t>& expected,
                     const std::string& owner);

/// What is known of the disk under a folder; bytes.
struct DiskMeasure {
  uint64_t size = 0;  ///< of the file system
  uint64_t free = 0;  ///< that this process may write
  uint64_t used = 0;  ///< by the folder itself; 0 where there is no budget
};

/// What a folder may take of its disk.
struct DiskLimits {
  uint64_t budget = 0;  ///< bytes that the folder may take; 0: no limit
  /// Bytes of the file system that are kept free; by default a twentieth of it, at most 2 GiB.
  std::optional<uint64_t> reserve;
};

/// How full it is. What is begun already lives on the reserve.
enum class DiskLevel : uint8_t {
  roomy,
  low,  ///< within the reserve: nothing new is begun or taken in
  full  ///< only a quarter of the reserve is left: even what was begun waits
};

/// Decides by measures of the disk whether there is room. Pure.
class DiskRoom {
 public:
  explicit DiskRoom(DiskLimits limits) : limits_(limits) {}

  /// Takes the present state in; whether level() has changed. A level that was left comes back only
  /// when there is a quarter of the reserve more than where it ended, so that it does not flutter.
  bool update(const DiskMeasure& now);

  /// The worse of the file system's and the budget's.
  DiskLevel level() const { return disk_.level > budget_.level ? disk_.level : budget_.level; }
  /// Bytes that may still be written before the reserve is touched; 0 unless the level is roomy.
  uint64_t room() const;
  /// Bytes that would have to become free for the level to be roomy again; 0 where it is.
  uint64_t shortage() const;
  /// Why there is no room, for people; empty where there is.
  std::string reason() const;

 private:
  /// The file system, or the budget.
  struct Tank {
    uint64_t size = 0;
    uint64_t free = 0;
    uint64_t reserve = 0;
    uint64_t over = 0;  ///< beyond the size: of a budget
    DiskLevel level = DiskLevel::roomy;
    void fill(uint64_t size_now, uint64_t free_now, uint64_t reserve_now);
    uint64_t room() const;
    uint64_t shortage() const;
  };

  DiskLimits limits_;
  Tank disk_;
  Tank budget_;  ///< roomy where there is none
};

/// Measures the file system of `folder` (fast). An error where it cannot be asked.
core::Result<DiskMeasure> measure_disk(const std::string& folder);

/// Bytes of all files below `folder`, as the disk counts them; takes time in proportion to their
/// number. What vanishes meanwhile is not counted.
uint64_t measure_folder(const std::string& folder);

}  // namespace hyades::coordinator
