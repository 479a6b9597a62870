#include "coordinator/services/assets_service.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/answer.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/upload_note.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostAsked = 10'000;

grpc::Status invalid(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

/// Takes one file in. Writes as it reads, so that a client is never faster than the disk.
class Uploading final : public grpc::ServerReadReactor<grpc::ByteBuffer> {
 public:
  /// `caller` has been admitted, or not.
  Uploading(Controller& controller, ThreadPool& pool, const Admission& admission,
            grpc::CallbackServerContext& context, const Caller& caller,
            const grpc::Status& admitted)
      : controller_(controller),
        pool_(pool),
        store_(controller.assets()),
        caller_(caller),
        audit_(admission.audit()) {
    if (admitted.ok()) {
      visit_ = admission.visit(caller, [&context](const grpc::Status&) { context.TryCancel(); });
      StartRead(&bytes_);
    } else {
      Finish(admitted);
    }
  }

  void OnReadDone(bool ok) override {
    if (!pool_.submit([this, ok] { take_part(ok); })) Finish(crowded());
  }

  void OnDone() override { delete this; }

 private:
  void take_part(bool ok) {
    if (!ok) {
      finish(writer_ ? incomplete() : invalid("an upload begins with the file's digest and size"));
      return;
    }
    v1::UploadPart part;  // not kept: an emptied message holds on to its memory
    grpc::Status taken = parse(bytes_, farm::kMaxPartBytes, part);
    bytes_.Clear();
    if (taken.ok()) taken = take(part);
    if (!taken.ok()) {
      finish(taken);
    } else if (done_) {
      finish(grpc::Status::OK);
    } else {
      StartRead(&bytes_);
    }
  }

  void finish(const grpc::Status& status) {
    writer_.reset();  // what has come is there before the answer is
    Finish(status);
  }

  grpc::Status incomplete() const {
    return {grpc::StatusCode::ABORTED, fmt::format("{} of {} bytes have come: go on from there",
                                                   writer_->offset(), writer_->size())};
  }

  grpc::Status begin(const v1::UploadPart& part) {
    const auto digest = farm::digest_from_wire(part.sha256());
    if (!digest) return invalid(digest.error().message);
    const std::string name = core::to_hex(*digest);
    if (store_.contains(name, part.size())) {
      done_ = true;
      return grpc::Status::OK;
    }
    const uint64_t begun = std::min(store_.begun(name), part.size());
    if (grpc::Status room = controller_.disk().admit(part.size() - begun); !room.ok()) return room;
    auto writer = store_.write(name, part.size());
    if (!writer) {
      return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, writer.error().message,
                               std::chrono::seconds(10));
    }
    writer_.emplace(std::move(*writer));
    note_upload(audit_, caller_, name, part.size(), writer_->offset());
    return grpc::Status::OK;
  }

  grpc::Status take(const v1::UploadPart& part) {
    if (!writer_) {
      if (const grpc::Status begun = begin(part); !begun.ok() || done_) return begun;
    }
    std::span<const std::byte> data = std::as_bytes(std::span(part.chunk().data()));
    if (data.size() > farm::kMaxChunkBytes) return invalid("a chunk has at most 1 MiB");
    // A stream that goes on for ever says nothing, or the same again. Where all bytes are here from
    // before a crash, there is nothing left to say.
    if (data.empty() && writer_->offset() < writer_->size()) return invalid("a part without data");
    received_ += data.size();
    if (received_ > writer_->size()) {
      return invalid(fmt::format("more than the {} bytes that were announced", writer_->size()));
    }
    const uint64_t offset = part.chunk().offset();
    if (offset > writer_->offset()) {
      return {grpc::StatusCode::OUT_OF_RANGE,
              fmt::format("bytes from {} on are missing", writer_->offset())};
    }
    // What is here already comes again where the client did not know of it.
    const uint64_t known = std::min<uint64_t>(writer_->offset() - offset, data.size());
    data = data.subspan(known);
    if (data.size() > writer_->size() - writer_->offset()) {
      return invalid(fmt::format("more than the {} bytes that were announced", writer_->size()));
    }
    if (controller_.disk().is_full()) {
      // What has come stays for a later upload to go on with.
      if (grpc::Status room = controller_.disk().admit(0); !room.ok()) return room;
    }
    if (auto written = writer_->append(data); !written) {
      return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, written.error().message,
                               std::chrono::seconds(10));
    }
    if (writer_->offset() < writer_->size()) return grpc::Status::OK;
    if (auto whole = writer_->commit(); !whole) {
      if (grpc::Status room = controller_.disk().admit(0); !room.ok()) return room;
      return {grpc::StatusCode::DATA_LOSS, whole.error().message};
    }
    done_ = true;
    return grpc::Status::OK;
  }

  Controller& controller_;
  ThreadPool& pool_;
  farm::ContentStore& store_;
  const Caller caller_;
  AuditLog* const audit_;
  std::unique_ptr<Visit> visit_;
  grpc::ByteBuffer bytes_;
  std::optional<farm::ContentWriter> writer_;
  uint64_t received_ = 0;  ///< on this stream
  bool done_ = false;
};

}  // namespace

grpc::ServerUnaryReactor* AssetsService::FindMissing(Context* context, const Bytes* asked,
                                                     Bytes* said) {
  const auto find = [this](const v1::FindMissingRequest& request,
                           v1::FindMissingResponse& response) {
    if (request.files_size() > kMostAsked) return invalid("at most 10,000 files at a time");
    std::set<std::string> seen;
    for (const v1::JobFile& file : request.files()) {
      const auto digest = farm::digest_from_wire(file.sha256());
      if (!digest) return invalid(digest.error().message);
      const std::string name = core::to_hex(*digest);
      if (!seen.insert(name).second || store_.contains(name, file.size())) continue;
      auto* missing = response.add_missing();
      missing->set_sha256(file.sha256());
      missing->set_offset(std::min(store_.begun(name), file.size()));
    }
    return grpc::Status::OK;
  };
  return answer_by<v1::FindMissingRequest, v1::FindMissingResponse>(
      executors_.files, {admission_, "Assets/FindMissing", context, asked, said}, find,
      farm::kMaxMessageBytes);
}

grpc::ServerReadReactor<grpc::ByteBuffer>* AssetsService::Upload(Context* context, Bytes* said) {
  (void)serialise(v1::UploadResponse(), *said);
  Caller caller;
  const grpc::Status admitted = admission_.check(*context, rule_of_method("Assets/Upload"), caller);
  return new Uploading(controller_, executors_.files, admission_, *context, caller, admitted);
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* AssetsService::Download(Context* context,
                                                                    const Bytes* asked) {
  const auto refuse = [](const grpc::Status& status) { return new Refusal(status); };
  Caller caller;
  const grpc::Status admitted =
      admission_.check(*context, rule_of_method("Assets/Download"), caller);
  if (!admitted.ok()) return refuse(admitted);
  v1::DownloadRequest request;
  if (const grpc::Status read = parse(*asked, farm::kMaxRequestBytes, request); !read.ok()) {
    return refuse(read);
  }
  const auto digest = farm::digest_from_wire(request.sha256());
  if (!digest) return refuse(invalid(digest.error().message));
  const auto open = [this, name = core::to_hex(*digest)](core::Bytes& file) -> grpc::Status {
    auto bytes = store_.read(name);
    if (!bytes) return {grpc::StatusCode::NOT_FOUND, bytes.error().message};
    file = std::move(*bytes);
    return grpc::Status::OK;
  };
  auto* stream = new FileStream(*context, executors_.files, open, request.offset());
  stream->guard(admission_, caller);
  return stream;
}

}  // namespace hyades::coordinator
