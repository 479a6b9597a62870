#pragma once

#include <algorithm>
#include <utility>

#include "coordinator/services/producer.h"
#include "core/base/bytes.h"
#include "farm/wire.h"
#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {

/// A stream that says no.
class Refusal final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  explicit Refusal(const grpc::Status& status) { Finish(status); }
  void OnDone() override { delete this; }
};

/// Bytes from an offset on, in chunks.
class FileStream final : public Producer<v1::Chunk> {
 public:
  FileStream(grpc::CallbackServerContext& context, core::Bytes bytes, uint64_t offset)
      : Producer(context), bytes_(std::move(bytes)), offset_(offset) {
    begin();
  }

 private:
  Step next(v1::Chunk& chunk, grpc::Status&) override {
    if (offset_ >= bytes_.size()) return Step::end;
    const uint64_t count = std::min<uint64_t>(farm::kMaxChunkBytes, bytes_.size() - offset_);
    chunk.set_offset(offset_);
    chunk.set_data(bytes_.chars() + offset_, count);
    offset_ += count;
    return Step::message;
  }

  core::Bytes bytes_;
  uint64_t offset_;
};

}  // namespace hyades::coordinator
