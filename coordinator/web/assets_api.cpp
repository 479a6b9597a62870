#include "coordinator/web/assets_api.h"

#include <algorithm>
#include <span>

#include "coordinator/operations/audit.h"
#include "coordinator/web/route_helpers.h"
#include "farm/content_store.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostOpen = 64;
constexpr std::chrono::seconds kOpenFor{60};

grpc::Status invalid(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

}  // namespace

void AssetsApi::add_routes(Router& router) {
  add_by_hand<v1::PieceRequest>(
      router, executors_.files, "PUT", "/api/v1/assets/{sha256}",
      [this](const v1::PieceRequest& asked, const WebRequest& request) {
        if (!farm::is_content_name(asked.sha256())) {
          return error_reply(invalid("sha256: expected 64 hexadecimal digits in small letters"));
        }
        if (!asked.has_size()) {
          return error_reply(invalid("size: expected the size of the whole file"));
        }
        return take(request.caller, asked, request.body);
      });
}

WebReply AssetsApi::take(const Caller& caller, const v1::PieceRequest& asked,
                         const std::string& piece) {
  const std::string& name = asked.sha256();
  const uint64_t size = asked.size();
  if (controller_.assets().contains(name, size)) {
    return json_reply({{"offset", size}, {"complete", true}});
  }
  if (controller_.disk().is_full()) {
    // What has come stays for a later upload to go on with.
    if (const grpc::Status room = controller_.disk().admit(0); !room.ok()) return error_reply(room);
  }
  {
    const std::lock_guard lock(mutex_);
    if (!busy_.insert(name).second) {
      return error_reply(farm::retry_later(grpc::StatusCode::ABORTED,
                                           "another piece of this file is being written",
                                           std::chrono::milliseconds(500)));
    }
  }
  auto writer = take_writer(caller, name, size);
  WebReply reply =
      writer.ok() ? append(*writer.writer, asked.offset(), piece) : error_reply(writer.status);
  if (writer.ok() && writer.writer->offset() < size) put_back(name, std::move(writer.writer));
  done_with(name);
  return reply;
}

void AssetsApi::done_with(const std::string& name) {
  const std::lock_guard lock(mutex_);
  busy_.erase(name);
}

void AssetsApi::sweep() {
  const std::lock_guard lock(mutex_);
  let_go_of_old();
}

WebReply AssetsApi::append(farm::ContentWriter& writer, uint64_t offset, const std::string& piece) {
  const uint64_t size = writer.size();
  if (offset > writer.offset()) {
    return error_reply({grpc::StatusCode::OUT_OF_RANGE,
                        fmt::format("bytes from {} on are missing", writer.offset())});
  }
  if (offset > size || piece.size() > size - offset) {
    return error_reply(invalid(fmt::format("more than the {} bytes that were announced", size)));
  }
  // What is here already comes again where the client did not know of it.
  const auto bytes = std::as_bytes(std::span(piece));
  const uint64_t known = std::min<uint64_t>(writer.offset() - offset, bytes.size());
  if (auto written = writer.append(bytes.subspan(known)); !written) {
    return error_reply(farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                         written.error().message, std::chrono::seconds(10)));
  }
  if (writer.offset() < size) {
    return json_reply({{"offset", writer.offset()}, {"complete", false}});
  }
  if (auto whole = writer.commit(); !whole) {
    if (const grpc::Status room = controller_.disk().admit(0); !room.ok()) return error_reply(room);
    return error_reply({grpc::StatusCode::DATA_LOSS, whole.error().message});
  }
  return json_reply({{"offset", size}, {"complete", true}});
}

AssetsApi::Taken AssetsApi::take_writer(const Caller& caller, const std::string& name,
                                        uint64_t size) {
  {
    const std::lock_guard lock(mutex_);
    let_go_of_old();
    const auto open = open_.find(name);
    if (open != open_.end() && open->second.writer->size() == size) {
      Taken taken{std::move(open->second.writer), grpc::Status::OK};
      open_.erase(open);
      return taken;
    }
  }
  const uint64_t begun = std::min(controller_.assets().begun(name), size);
  if (grpc::Status room = controller_.disk().admit(size - begun); !room.ok())
    return {nullptr, room};
  auto writer = controller_.assets().write(name, size);
  if (!writer) {
    return {nullptr, farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, writer.error().message,
                                       std::chrono::seconds(10))};
  }
  note_upload(audit_, caller, name, size, writer->offset());
  return {std::make_unique<farm::ContentWriter>(std::move(*writer)), grpc::Status::OK};
}

void AssetsApi::put_back(const std::string& name, std::unique_ptr<farm::ContentWriter> writer) {
  const std::lock_guard lock(mutex_);
  // Without its writer the next piece reads again what is there.
  if (open_.size() < kMostOpen) {
    open_[name] = {std::move(writer), std::chrono::steady_clock::now()};
  }
}

/// With the lock.
void AssetsApi::let_go_of_old() {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(open_, [&](const auto& open) { return now - open.second.used > kOpenFor; });
}

}  // namespace hyades::coordinator
