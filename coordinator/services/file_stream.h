#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/producer.h"
#include "core/base/bytes.h"
#include "farm/wire.h"
#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {

/// A file's bytes from an offset on, in chunks. To touch them is to read the disk.
class FileStream final : public Producer<v1::Chunk> {
 public:
  /// `open` finds the bytes, or says why not; called once, by one of the pool.
  using Open = std::function<grpc::Status(core::Bytes&)>;
  FileStream(grpc::CallbackServerContext& context, ThreadPool& pool, Open open, uint64_t offset)
      : Producer(context, pool), open_(std::move(open)), offset_(offset) {}

 private:
  Step next(v1::Chunk& chunk, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::hand;
    if (const Open open = std::exchange(open_, nullptr)) {
      status = open(bytes_);
      if (status.ok() && offset_ > bytes_.size()) {
        status = {grpc::StatusCode::OUT_OF_RANGE,
                  fmt::format("the file has {} bytes", bytes_.size())};
      }
      if (!status.ok()) return Step::end;
    }
    if (offset_ >= bytes_.size()) return Step::end;
    const uint64_t count = std::min<uint64_t>(farm::kMaxChunkBytes, bytes_.size() - offset_);
    chunk.set_offset(offset_);
    chunk.set_data(bytes_.chars() + offset_, count);
    offset_ += count;
    return Step::message;
  }

  Open open_;
  core::Bytes bytes_;
  uint64_t offset_;
};

}  // namespace hyades::coordinator
