// Files by content, up and down.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/audit.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/service.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/assets.pb.h"

namespace hyades::coordinator {
namespace {

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

void add_asset_streams(Service& service) {
  Controller& controller = service.backend().controller;
  service.add_writer(
      "Assets/Upload",
      [&service, &controller](Service::Context& context, const Caller& caller,
                              const grpc::Status& admitted) {
        return new Uploading(controller, service.executors().files, service.admission(), context,
                             caller, admitted);
      },
      v1::UploadResponse::default_instance());
  service.add_reader<v1::DownloadRequest>(
      "Assets/Download",
      [&service, &controller](Service::Context& context, v1::DownloadRequest&& request,
                              grpc::Status& refused) -> OutgoingStream* {
        const auto digest = farm::digest_from_wire(request.sha256());
        if (!digest) {
          refused = invalid(digest.error().message);
          return nullptr;
        }
        const auto open = [&controller,
                           name = core::to_hex(*digest)](core::Bytes& file) -> grpc::Status {
          auto bytes = controller.assets().read(name);
          if (!bytes) return {grpc::StatusCode::NOT_FOUND, bytes.error().message};
          file = std::move(*bytes);
          return grpc::Status::OK;
        };
        return new FileStream(context, service.executors().files, open, request.offset());
      });
}

}  // namespace hyades::coordinator
