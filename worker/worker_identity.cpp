#include "worker/worker_identity.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
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

/// What the file says where it was written whole, by this machine.
std::string read_id(int fd, const std::string& machine) {
  std::array<char, 512> bytes{};
  const auto size = core::read_all_at(fd, std::as_writable_bytes(std::span(bytes)), 0);
  const std::string text(bytes.data(), size.value_or(0));
  const std::string id = text.substr(0, kIdLength);
  return is_id(id) && text == id + " " + machine + "\n" ? id : std::string();
}

}  // namespace

core::Result<WorkerIdentity> WorkerIdentity::take(const std::string& cache_folder,
                                                  const std::string& machine) {
  for (int number = 0; number < kMostWorkers; ++number) {
    const std::string path = fmt::format("{}/worker-{}.id", cache_folder, number);
    const auto failed = [&](const char* what) {
      return core::Error{fmt::format("cannot {} {}: {}", what, path, core::io_reason(errno))};
    };
    core::Descriptor file = core::open_file(path, O_RDWR | O_CREAT, 0600);
    if (!file.valid()) return failed("open");
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) continue;
      return failed("lock");
    }
    WorkerIdentity id(path, machine, std::move(file));
    id.text_ = read_id(id.lock_.get(), machine);
    if (id.text_.empty()) {
      if (auto made = id.renew(); !made) return made.error();
    }
    return id;
  }
  return core::Error{
      fmt::format("{}: {} workers run with this cache already", cache_folder, kMostWorkers)};
}

core::Status WorkerIdentity::renew() {
  auto fresh = core::random_id();
  if (!fresh) return fresh.error();
  const std::string text = *fresh + " " + machine_ + "\n";
  if (::ftruncate(lock_.get(), 0) != 0 ||
      !core::write_all_at(lock_.get(), std::as_bytes(std::span(text)), 0) ||
      ::fsync(lock_.get()) != 0) {
    return core::Error{fmt::format("cannot write {}: {}", path_, core::io_reason(errno))};
  }
  text_ = *fresh;
  return {};
}

std::string WorkerIdentity::token_file() const {
  return std::filesystem::path(path_).replace_extension(".token").string();
}

std::string machine_name(const std::string& host, const std::string& id_file) {
  std::ifstream file(id_file);
  std::string id;
  if (!(file >> id)) return host;
  // A hash, as the id itself is nobody else's business.
  return host + "/" + core::to_hex(core::sha256("hyades worker " + id)).substr(0, kIdLength);
}

}  // namespace hyades::worker
