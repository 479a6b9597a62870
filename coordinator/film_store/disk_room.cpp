#include "coordinator/film_store/disk_room.h"

#include <sys/stat.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kShareKept = 20;  // a twentieth
constexpr uint64_t kMostKept = uint64_t{2} << 30U;
constexpr uint64_t kDiskUnit = 512;  // of st_blocks

uint64_t default_reserve(uint64_t size) { return std::min(size / kShareKept, kMostKept); }

}  // namespace

uint64_t room_beside(uint64_t room, const std::map<std::string, uint64_t>& expected,
                     const std::string& owner) {
  std::vector<uint64_t> others;
  for (const auto& [whose, bytes] : expected) {
    if (whose == owner) {
      room = surplus(room, bytes);
    } else {
      others.push_back(bytes);
    }
  }
  std::sort(others.rbegin(), others.rend());
  for (const uint64_t bytes : others) room -= std::min(bytes, room / 2);
  return room;
}

void DiskRoom::Tank::fill(uint64_t size_now, uint64_t free_now, uint64_t reserve_now) {
  size = size_now;
  free = free_now;
  reserve = reserve_now;
  // Whoever has sunk below a line has to come a little above it.
  const auto below = [&](uint64_t line, DiskLevel its) {
    return free < std::max<uint64_t>(line + (level >= its ? reserve / 4 : 0), 1);
  };
  level = below(reserve / 4, DiskLevel::full) ? DiskLevel::full
          : below(reserve, DiskLevel::low)    ? DiskLevel::low
                                              : DiskLevel::roomy;
}

uint64_t DiskRoom::Tank::room() const {
  return level == DiskLevel::roomy ? surplus(free, reserve) : 0;
}

uint64_t DiskRoom::Tank::shortage() const {
  if (level == DiskLevel::roomy) return 0;
  return over + surplus(std::max<uint64_t>(reserve + reserve / 4, 1), free);
}

bool DiskRoom::update(const DiskMeasure& now) {
  const DiskLevel before = level();
  disk_.fill(now.size, now.free, limits_.reserve.value_or(default_reserve(now.size)));
  if (limits_.budget > 0) {
    budget_.fill(limits_.budget, surplus(limits_.budget, now.used),
                 default_reserve(limits_.budget));
    budget_.over = surplus(now.used, limits_.budget);
  }
  return level() != before;
}

uint64_t DiskRoom::room() const {
  return limits_.budget > 0 ? std::min(disk_.room(), budget_.room()) : disk_.room();
}

uint64_t DiskRoom::shortage() const { return std::max(disk_.shortage(), budget_.shortage()); }

std::string DiskRoom::reason() const {
  if (level() == DiskLevel::roomy) return {};
  if (budget_.level >= disk_.level) {
    return fmt::format("the coordinator's data take {} of the {} that they may (--disk-budget)",
                       core::format_bytes(budget_.size - budget_.free),
                       core::format_bytes(budget_.size));
  }
  return fmt::format(
      "the coordinator's disk is nearly full: {} of {} are free, {} are kept (--disk-reserve)",
      core::format_bytes(disk_.free), core::format_bytes(disk_.size),
      core::format_bytes(disk_.reserve));
}

core::Result<DiskMeasure> measure_disk(const std::string& folder) {
  struct statvfs info {};
  if (::statvfs(folder.c_str(), &info) != 0) {
    return core::Error{folder + ": the room on its disk is not known: " + core::io_reason(errno)};
  }
  return DiskMeasure{uint64_t{info.f_blocks} * info.f_frsize,
                     uint64_t{info.f_bavail} * info.f_frsize, 0};
}

uint64_t measure_folder(const std::string& folder) {
  uint64_t bytes = 0;
  std::vector<std::string> folders = {folder};
  while (!folders.empty()) {
    const std::string next = std::move(folders.back());
    folders.pop_back();
    std::error_code failed;
    fs::directory_iterator at(next, failed);
    for (const fs::directory_iterator end; !failed && at != end; at.increment(failed)) {
      struct stat info {};
      if (::lstat(at->path().c_str(), &info) != 0) continue;
      bytes += static_cast<uint64_t>(info.st_blocks) * kDiskUnit;
      if (S_ISDIR(info.st_mode)) folders.push_back(at->path().string());
    }
  }
  return bytes;
}

}  // namespace hyades::coordinator
