#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/operations/file_transfer.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/producer.h"
#include "core/job/made_file.h"
#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {

/// Sends an output's bytes from an offset on, in chunks. DATA_LOSS where the file changes
/// meanwhile.
class OutputStream final : public Producer<v1::Chunk> {
 public:
  /// Finds the file, or says why there is none; called once, by a thread of the pool.
  using Find = std::function<grpc::Status(core::MadeFile&)>;
  OutputStream(grpc::CallbackServerContext& context, farm::ThreadPool& pool, Find find,
               std::string path, uint64_t offset)
      : Producer(context, pool), find_(std::move(find)), path_(std::move(path)), offset_(offset) {}

 private:
  Step next(v1::Chunk& chunk, grpc::Status& status, bool may_wait) override {
    if (!may_wait) return Step::needs_thread;
    if (const Find find = std::exchange(find_, nullptr)) {
      status = find(file_);
      if (status.ok() && offset_ > file_.size()) {
        status = {grpc::StatusCode::OUT_OF_RANGE,
                  fmt::format("the file has {} bytes", file_.size())};
      }
      if (!status.ok()) return Step::end;
    }
    if (offset_ >= file_.size()) return Step::end;
    std::string& bytes = *chunk.mutable_data();
    bytes.resize(std::min<uint64_t>(kFilePieceBytes, file_.size() - offset_));
    if (!file_.read(offset_, std::as_writable_bytes(std::span(bytes)))) {
      status = damaged_output(path_);
      return Step::end;
    }
    chunk.set_offset(offset_);
    offset_ += bytes.size();
    return Step::message;
  }

  Find find_;
  const std::string path_;
  core::MadeFile file_;
  uint64_t offset_;
};

}  // namespace hyades::coordinator
