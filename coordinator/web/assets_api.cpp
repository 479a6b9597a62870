#include "coordinator/web/assets_api.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/operations/file_transfer.h"
#include "coordinator/web/route_helpers.h"
#include "farm/content_store.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// Of all, and of one owner.
constexpr size_t kMostOpen = 512;
constexpr size_t kMostOpenOfOne = 64;
constexpr std::chrono::seconds kOpenFor{60};

grpc::Status invalid(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

}  // namespace

void AssetsApi::add_routes(Router& router) {
  add_by_hand<v1::PieceRequest>(
      router, executors_, "PUT", "/api/v1/assets/{sha256}",
      [this](const v1::PieceRequest& asked, const WebRequest& request) {
        if (!farm::is_content_name(asked.sha256())) {
          return error_reply(invalid("sha256: expected 64 hexadecimal digits in small letters"));
        }
        if (!asked.has_size()) {
          return error_reply(invalid("size: expected the size of the whole file"));
        }
        uint64_t offset = 0;
        const grpc::Status taken = take(request.caller, asked, request.body, offset);
        if (!taken.ok()) return error_reply(taken);
        return json_reply({{"offset", offset}, {"complete", offset == asked.size()}});
      });
}

/// Holds a file for as long as it lives, unless another does.
class AssetsApi::Hold {
 public:
  Hold(AssetsApi& api, const FileOf& file) : api_(api), file_(file) {
    const core::MutexLock lock(api_.mutex_);
    held_ = api_.busy_.insert(file_).second;
  }
  ~Hold() {
    const core::MutexLock lock(api_.mutex_);
    if (held_) api_.busy_.erase(file_);
  }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;
  bool held() const { return held_; }

 private:
  AssetsApi& api_;
  const FileOf file_;
  bool held_ = false;
};

grpc::Status AssetsApi::take(const Caller& caller, const v1::PieceRequest& asked,
                             const std::string& piece, uint64_t& offset) {
  const FileOf file{caller.name, asked.sha256()};
  const Hold hold(*this, file);
  if (!hold.held()) {
    return farm::retry_later(grpc::StatusCode::ABORTED,
                             "another piece of this file is being written",
                             std::chrono::milliseconds(500));
  }
  auto writer = take_open(file);
  if (writer && writer->size() != asked.size()) {
    const uint64_t size = writer->size();
    put_back(file, std::move(writer));
    return invalid(fmt::format("size: expected {}, with which the upload began", size));
  }
  if (!writer) {
    const grpc::Status begun =
        begin_upload(controller_, audit_, caller, file.name, asked.size(), writer);
    offset = asked.size();
    if (!begun.ok() || !writer) return begun;
  }
  grpc::Status taken =
      take_piece(controller_, caller, *writer, asked.offset(), std::as_bytes(std::span(piece)));
  offset = writer->offset();
  if (offset < asked.size()) put_back(file, std::move(writer));
  return taken;
}

void AssetsApi::sweep() {
  const core::MutexLock lock(mutex_);
  let_go_of_old();
}

std::unique_ptr<farm::ContentWriter> AssetsApi::take_open(const FileOf& file) {
  const core::MutexLock lock(mutex_);
  let_go_of_old();
  const auto open = open_.extract(file);
  return open ? std::move(open.mapped().writer) : nullptr;
}

void AssetsApi::put_back(const FileOf& file, std::unique_ptr<farm::ContentWriter> writer) {
  const core::MutexLock lock(mutex_);
  const auto own = std::count_if(open_.begin(), open_.end(),
                                 [&](const auto& open) { return open.first.owner == file.owner; });
  // Without its writer the next piece reads again what is there.
  if (open_.size() < kMostOpen && static_cast<size_t>(own) < kMostOpenOfOne) {
    open_[file] = {std::move(writer), std::chrono::steady_clock::now()};
  }
}

void AssetsApi::let_go_of_old() {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(open_, [&](const auto& open) { return now - open.second.used > kOpenFor; });
}

}  // namespace hyades::coordinator
