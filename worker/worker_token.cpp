#include "worker/worker_token.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include "farm/channel.h"
#include "farm/small_file.h"

namespace hyades::worker {
namespace {

/// Whether a machine's token, "hyades-ID-CODE-WORKER", is the worker's and was made from the token
/// "hyades-ID-SECRET"; the latter may be empty.
bool belongs(const std::string& own, const std::string& worker_id, const std::string& join) {
  constexpr size_t kIdEnd = sizeof "hyades-00000000-" - 1;
  return own.ends_with("-" + worker_id) &&
         (join.empty() || own.substr(0, kIdEnd) == join.substr(0, kIdEnd));
}

}  // namespace

core::Status WorkerToken::read(const std::string& worker_id) {
  own_.clear();
  join_.clear();
  joins_ = false;
  if (join_file_.empty()) return {};
  auto join = farm::read_token(join_file_);
  if (join) join_ = *join;
  std::error_code failed;
  if (std::filesystem::exists(own_file_, failed)) {
    const auto own = farm::read_token(own_file_);
    if (own && belongs(*own, worker_id, join_)) own_ = *own;
  }
  return join || !own_.empty() ? core::Status() : core::Status(join.error());
}

core::Status WorkerToken::keep(const std::string& own, const std::string& worker_id) {
  constexpr size_t kLongest = 200;
  const bool plain = std::all_of(own.begin(), own.end(), [](char c) { return c > ' ' && c < 127; });
  if (own.size() > kLongest || !plain || !belongs(own, worker_id, join_)) {
    return core::Error{"what the coordinator has given is no token of this worker"};
  }
  if (auto written = farm::replace_secret(own_file_, own + "\n"); !written) return written;
  own_ = own;
  joins_ = false;
  return {};
}

bool WorkerToken::replace(const std::string& worker_id) {
  const std::string shown = text();
  const std::string refused = own_;
  if (!read(worker_id)) return false;
  if (text() != shown) return text() != refused;
  joins_ = !join_.empty();
  return text() != shown;
}

}  // namespace hyades::worker
