#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/producer.h"
#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {

/// Bytes of a file in one message. Each waits in memory until the client reads it, and many
/// clients may be slow.
inline constexpr uint64_t kFilePieceBytes = uint64_t{64} << 10U;

/// A file that is sent.
struct FileToSend {
  uint64_t size = 0;  ///< bytes
  /// Puts its bytes from `offset` on into all of `into`; an error ends the stream.
  std::function<grpc::Status(uint64_t offset, std::span<std::byte> into)> read;
};

/// Sends a file's bytes from an offset on, in chunks. OUT_OF_RANGE where the file ends before it.
class FileStream final : public Producer<v1::Chunk> {
 public:
  /// Finds the file, or says why there is none; called once, by a thread of the pool.
  using Open = std::function<grpc::Status(FileToSend&)>;
  FileStream(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Open open,
             uint64_t offset)
      : Producer(context, pool), open_(std::move(open)), offset_(offset) {}

 private:
  Step next(v1::Chunk& chunk, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::needs_thread;  // to read is to wait for the disk
    if (const Open open = std::exchange(open_, nullptr)) {
      status = open(file_);
      if (status.ok() && offset_ > file_.size) {
        status = {grpc::StatusCode::OUT_OF_RANGE, fmt::format("the file has {} bytes", file_.size)};
      }
      if (!status.ok()) return Step::end;
    }
    if (offset_ >= file_.size) return Step::end;
    std::string& bytes = *chunk.mutable_data();
    bytes.resize(std::min(kFilePieceBytes, file_.size - offset_));
    status = file_.read(offset_, std::as_writable_bytes(std::span(bytes)));
    if (!status.ok()) return Step::end;
    chunk.set_offset(offset_);
    offset_ += bytes.size();
    return Step::message;
  }

  Open open_;
  FileToSend file_;
  uint64_t offset_;
};

}  // namespace hyades::coordinator
