// The film log against the disk that it lies on: records made durable per second, and in the next
// half second the same bytes in the same groups by write and fdatasync alone. They take turns, for
// a shared disk changes by the second. usage: bench_store [FOLDER]
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRounds = 12;
constexpr std::chrono::milliseconds kRound{500};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Bytes that do not compress, as films' do not.
std::vector<std::byte> record_of(size_t size) {
  std::vector<std::byte> bytes(size);
  uint64_t state = 1;
  for (std::byte& b : bytes) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    b = static_cast<std::byte>(state >> 56U);
  }
  return bytes;
}

/// What is on its way to the disk, as a coordinator bounds it.
struct Window {
  std::mutex mutex;
  std::condition_variable moved;
  uint64_t durable = 0;
  uint64_t groups = 0;
};

struct Speed {
  double bytes_per_second = 0;
  size_t group_bytes = 0;  ///< of the mean group
};

Speed log_speed(const std::string& folder, const std::vector<std::byte>& record, size_t window) {
  Window shared;
  FilmLogOptions options;
  options.on_durable = [&](uint64_t through) {
    const std::lock_guard lock(shared.mutex);
    shared.durable = through;
    ++shared.groups;
    shared.moved.notify_one();
  };
  auto log = FilmLog::open(folder, "bench", options);
  if (!log || !(*log)->replay([](std::span<const std::byte>) { return core::Status(); })) {
    return {};
  }
  const Clock::time_point begin = Clock::now();
  uint64_t last = 0;
  uint64_t first = 0;
  while (Clock::now() < begin + kRound) {
    {
      std::unique_lock lock(shared.mutex);
      shared.moved.wait(lock, [&] { return last - std::max(first, shared.durable) < window; });
    }
    const auto sequence = (*log)->append(record);
    if (!sequence) return {};
    if (first == 0) last = first = *sequence - 1;
    last = *sequence;
  }
  if (!(*log)->sync()) return {};
  const double seconds = seconds_since(begin);
  const double bytes = static_cast<double>(last - first) * static_cast<double>(record.size());
  const std::lock_guard lock(shared.mutex);
  return {bytes / seconds, static_cast<size_t>(bytes / static_cast<double>(shared.groups))};
}

double disk_speed(const std::string& path, size_t group_bytes) {
  const std::vector<std::byte> group = record_of(group_bytes);
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return 0;
  const Clock::time_point begin = Clock::now();
  double bytes = 0;
  while (Clock::now() < begin + kRound) {
    for (size_t done = 0; done < group.size();) {
      const ssize_t n = ::write(file, group.data() + done, group.size() - done);
      if (n <= 0) return 0;
      done += static_cast<size_t>(n);
    }
    if (::fdatasync(file) != 0) return 0;
    bytes += static_cast<double>(group.size());
  }
  const double speed = bytes / seconds_since(begin);
  ::close(file);
  return speed;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

bool measure(const std::string& folder, size_t record_bytes, size_t window) {
  const std::vector<std::byte> record = record_of(record_bytes);
  std::vector<double> ours;
  std::vector<double> disks;
  std::vector<double> ratios;
  size_t group_bytes = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::string place = folder + "/" + std::to_string(round);
    const Speed log = log_speed(place, record, window);
    const double disk = disk_speed(place + ".plain", std::max<size_t>(log.group_bytes, 1));
    std::filesystem::remove_all(place);
    std::filesystem::remove(place + ".plain");
    if (log.bytes_per_second <= 0 || disk <= 0) return false;
    group_bytes = log.group_bytes;
    ours.push_back(log.bytes_per_second);
    disks.push_back(disk);
    ratios.push_back(log.bytes_per_second / disk);
  }
  std::printf(
      "records of %7zu bytes: %7.0f/s durable, %6.1f MB/s; the disk alone in groups of %zu KB "
      "%6.1f MB/s; ratio %.0f %% (medians)\n",
      record_bytes, median(ours) / static_cast<double>(record_bytes), median(ours) / 1e6,
      group_bytes / 1000, median(disks) / 1e6, 100 * median(ratios));
  return true;
}

}  // namespace
}  // namespace hyades::coordinator

int main(int argc, char** argv) {
  const hyades::test::TempFolder scratch;
  const std::string folder = argc > 1 ? argv[1] : scratch.path().string();
  // As many as a busy farm has on their way.
  const bool ok = hyades::coordinator::measure(folder, 4'096, 4'000) &&
                  hyades::coordinator::measure(folder, 200'000, 200) &&
                  hyades::coordinator::measure(folder, 2'000'000, 60);
  if (!ok) std::fprintf(stderr, "%s cannot be written to\n", folder.c_str());
  return ok ? 0 : 1;
}
