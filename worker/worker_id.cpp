#include "worker/worker_id.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/random_id.h"

namespace hyades::worker {
namespace {

/// More workers than share one folder.
constexpr int kMostWorkers = 4096;
constexpr size_t kIdLength = 32;

bool is_id(const std::string& text) {
  return text.size() == kIdLength && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

/// What the file says where it was written whole, by this host.
std::string read_id(int fd, const std::string& host) {
  std::array<char, 512> bytes{};
  const ssize_t size = ::pread(fd, bytes.data(), bytes.size(), 0);
  if (size <= 0) return {};
  const std::string text(bytes.data(), static_cast<size_t>(size));
  const std::string id = text.substr(0, kIdLength);
  return is_id(id) && text == id + " " + host + "\n" ? id : std::string();
}

}  // namespace

core::Result<WorkerId> WorkerId::take(const std::string& cache_folder, const std::string& host) {
  for (int number = 0; number < kMostWorkers; ++number) {
    const std::string path = fmt::format("{}/worker-{}.id", cache_folder, number);
    const auto failed = [&](const char* what) {
      return core::Error{fmt::format("cannot {} {}: {}", what, path, core::io_reason(errno))};
    };
    core::Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    if (!file.valid()) return failed("open");
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) continue;
      return failed("lock");
    }
    std::string id = read_id(file.get(), host);
    if (id.empty()) {
      auto fresh = core::random_id();
      if (!fresh) return fresh.error();
      id = *fresh;
      const std::string text = id + " " + host + "\n";
      if (::ftruncate(file.get(), 0) != 0 ||
          ::pwrite(file.get(), text.data(), text.size(), 0) != std::ssize(text) ||
          ::fsync(file.get()) != 0) {
        return failed("write");
      }
    }
    return WorkerId(std::move(id), std::move(file));
  }
  return core::Error{
      fmt::format("{}: {} workers run with this cache already", cache_folder, kMostWorkers)};
}

}  // namespace hyades::worker
