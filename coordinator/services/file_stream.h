#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/producer.h"
#include "core/base/bytes.h"
#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {

/// Bytes of a file in one message. Each waits in memory until the client reads it, and many
/// clients may be slow.
inline constexpr uint64_t kFilePieceBytes = uint64_t{64} << 10U;

/// Puts what `bytes` holds from `offset` on into `chunk`, one piece at most, and moves `offset`
/// behind it. False where nothing is left.
inline bool take_chunk(std::span<const std::byte> bytes, uint64_t& offset, v1::Chunk& chunk) {
  if (offset >= bytes.size()) return false;
  const uint64_t count = std::min<uint64_t>(kFilePieceBytes, bytes.size() - offset);
  chunk.set_offset(offset);
  chunk.set_data(bytes.data() + offset, count);
  offset += count;
  return true;
}

/// Sends a file's bytes from an offset on, in chunks. To touch them is to read the disk.
class FileStream final : public Producer<v1::Chunk> {
 public:
  /// Finds the bytes, or says why there are none; called once, by a thread of the pool.
  using Open = std::function<grpc::Status(core::Bytes&)>;
  FileStream(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Open open,
             uint64_t offset)
      : Producer(context, pool), open_(std::move(open)), offset_(offset) {}

 private:
  Step next(v1::Chunk& chunk, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::needs_thread;
    if (const Open open = std::exchange(open_, nullptr)) {
      status = open(bytes_);
      if (status.ok() && offset_ > bytes_.size()) {
        status = {grpc::StatusCode::OUT_OF_RANGE,
                  fmt::format("the file has {} bytes", bytes_.size())};
      }
      if (!status.ok()) return Step::end;
    }
    return take_chunk(bytes_.span(), offset_, chunk) ? Step::message : Step::end;
  }

  Open open_;
  core::Bytes bytes_;
  uint64_t offset_;
};

}  // namespace hyades::coordinator
