// Files by content, up and down.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/access/caller.h"
#include "coordinator/controller/controller.h"
#include "coordinator/operations/file_transfer.h"
#include "coordinator/operations/ownership.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/service.h"
#include "farm/message_bytes.h"
#include "farm/wire.h"
#include "hyades/v1/assets.pb.h"

namespace hyades::coordinator {
namespace {

grpc::Status invalid(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

/// Takes one file in. Writes as it reads, so that a client is never faster than the disk.
class UploadStream final : public grpc::ServerReadReactor<grpc::ByteBuffer> {
 public:
  /// `caller` has been admitted, or not.
  UploadStream(Controller& controller, farm::ThreadPool& pool, const Admission& admission,
               grpc::CallbackServerContext& context, const Caller& caller,
               const grpc::Status& admitted)
      : controller_(controller), pool_(pool), caller_(caller), audit_(admission.audit()) {
    grpc::Status refused = admitted;
    if (admitted.ok()) entry_ = count_connection(controller, caller, refused);
    if (refused.ok()) {
      visit_ = admission.visit(caller, [&context](const grpc::Status&) { context.TryCancel(); });
      StartRead(&bytes_);
    } else {
      Finish(refused);
    }
  }

  void OnReadDone(bool ok) override {
    if (!pool_.submit([this, ok] { take_part(ok); }, owner_of(caller_).name)) {
      Finish(crowded());
    }
  }

  void OnDone() override { delete this; }

 private:
  void take_part(bool ok) {
    if (!ok) {
      finish(writer_ ? incomplete() : invalid("an upload begins with the file's digest and size"));
      return;
    }
    v1::UploadPart part;  // not kept: an emptied message holds on to its memory
    grpc::Status taken = farm::parse(bytes_, farm::kMaxPartBytes, part);
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
    grpc::Status begun = begin_upload(controller_, audit_, caller_, name, part.size(), writer_);
    done_ = begun.ok() && !writer_;
    return begun;
  }

  grpc::Status take(const v1::UploadPart& part) {
    if (!writer_) {
      if (const grpc::Status begun = begin(part); !begun.ok() || done_) return begun;
    }
    const std::span<const std::byte> data = std::as_bytes(std::span(part.chunk().data()));
    if (data.size() > farm::kMaxChunkBytes) return invalid("a chunk has at most 1 MiB");
    // A stream that goes on for ever says nothing, or the same again. Where all bytes are here from
    // before a crash, there is nothing left to say.
    if (data.empty() && writer_->offset() < writer_->size()) return invalid("a part without data");
    received_ += data.size();
    if (received_ > writer_->size()) {
      return invalid(fmt::format("more than the {} bytes that were announced", writer_->size()));
    }
    grpc::Status taken = take_piece(controller_, caller_, *writer_, part.chunk().offset(), data);
    done_ = taken.ok() && writer_->offset() == writer_->size();
    return taken;
  }

  Controller& controller_;
  farm::ThreadPool& pool_;
  const Caller caller_;
  AuditLog* const audit_;
  std::unique_ptr<OwnerConnections::Entry> entry_;
  std::unique_ptr<Visit> visit_;
  grpc::ByteBuffer bytes_;
  std::unique_ptr<farm::ContentWriter> writer_;
  uint64_t received_ = 0;  ///< on this stream
  bool done_ = false;
};

}  // namespace

void add_asset_streams(Service& service) {
  Controller& controller = service.backend().controller;
  service.add_client_stream(
      "Assets/Upload",
      [&service, &controller](Service::Context& context, const Caller& caller,
                              const grpc::Status& admitted) {
        return new UploadStream(controller, service.pool_of("Assets/Upload"), service.admission(),
                                context, caller, admitted);
      },
      v1::UploadResponse::default_instance());
  service.add_server_stream<v1::DownloadRequest>(
      "Assets/Download",
      [&service, &controller](Service::Context& context, const Caller& /*caller*/,
                              v1::DownloadRequest&& request,
                              grpc::Status& refused) -> OutgoingStream* {
        const auto digest = farm::digest_from_wire(request.sha256());
        if (!digest) {
          refused = invalid(digest.error().message);
          return nullptr;
        }
        const auto open = [&controller,
                           name = core::to_hex(*digest)](FileToSend& file) -> grpc::Status {
          bool busy = false;
          auto bytes = controller.assets().read(name, &busy);
          if (busy) return still_checked();
          if (!bytes) return {grpc::StatusCode::NOT_FOUND, bytes.error().message};
          file.size = bytes->size();
          file.read = [bytes = std::move(*bytes)](uint64_t offset, std::span<std::byte> into) {
            std::memcpy(into.data(), bytes.span().data() + offset, into.size());
            return grpc::Status::OK;
          };
          return grpc::Status::OK;
        };
        return new FileStream(context, service.pool_of("Assets/Download"), open, request.offset());
      });
}

}  // namespace hyades::coordinator
