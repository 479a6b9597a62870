#include "coordinator/operations/file_transfer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coordinator/access/audit_log.h"
#include "coordinator/controller/controller.h"
#include "coordinator/operations/operation.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

grpc::Status no_room_for(const core::Error& error) {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, error.message,
                           std::chrono::seconds(10));
}

}  // namespace

grpc::Status begin_upload(Controller& controller, AuditLog* log, const Caller& caller,
                          const std::string& name, uint64_t size,
                          std::unique_ptr<farm::ContentWriter>& writer) {
  farm::ContentStore& assets = controller.assets();
  bool busy = false;
  if (assets.contains(name, size, &busy)) return grpc::Status::OK;
  if (busy) return still_checked();
  const uint64_t begun = std::min(assets.begun(name, caller.name), size);
  if (grpc::Status room = controller.disk().admit(size - begun, caller.name); !room.ok())
    return room;
  grpc::Status over_quota;
  const auto may_begin = [&](const farm::UnfinishedFiles& others) -> core::Status {
    over_quota = controller.quotas().may_upload(caller.name, size, others,
                                                controller.unclaimed().bytes_of(caller.name));
    if (over_quota.ok()) return {};
    return core::Error{over_quota.error_message()};
  };
  auto opened = assets.write(name, size, {caller.name, may_begin, &busy});
  if (busy) return still_checked();
  if (!opened) return over_quota.ok() ? no_room_for(opened.error()) : over_quota;
  writer = std::make_unique<farm::ContentWriter>(std::move(*opened));
  if (log == nullptr) return grpc::Status::OK;
  const uint64_t there = writer->offset();
  log->upload(caller, operation_of_method("Assets/Upload").rule.action, name,
              there == 0 ? fmt::format("{} bytes", size)
                         : fmt::format("{} bytes, goes on from {}", size, there));
  return grpc::Status::OK;
}

grpc::Status still_checked() {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "the file is still being checked on the coordinator's disk",
                           std::chrono::seconds(1));
}

grpc::Status take_piece(Controller& controller, const Caller& caller, farm::ContentWriter& writer,
                        uint64_t offset, std::span<const std::byte> bytes) {
  if (offset > writer.offset()) {
    return {grpc::StatusCode::OUT_OF_RANGE,
            fmt::format("bytes from {} on are missing", writer.offset())};
  }
  // What is here already comes again where the client did not know of it.
  bytes = bytes.subspan(std::min<uint64_t>(writer.offset() - offset, bytes.size()));
  if (bytes.size() > writer.size() - writer.offset()) {
    return {grpc::StatusCode::INVALID_ARGUMENT,
            fmt::format("more than the {} bytes that were announced", writer.size())};
  }
  if (controller.disk().is_full()) {
    // What has come stays for a later upload to go on with.
    if (grpc::Status room = controller.disk().admit(0); !room.ok()) return room;
  }
  if (auto written = writer.append(bytes); !written) return no_room_for(written.error());
  if (writer.offset() < writer.size()) return grpc::Status::OK;
  if (auto whole = writer.commit(); !whole) {
    if (grpc::Status room = controller.disk().admit(0); !room.ok()) return room;
    return {grpc::StatusCode::DATA_LOSS, whole.error().message};
  }
  if (controller.quotas().limits_bytes()) {
    controller.unclaimed().add(caller.name, writer.name(), writer.size());
  }
  return grpc::Status::OK;
}

grpc::Status damaged_output(const std::string& path) {
  return {grpc::StatusCode::DATA_LOSS, path + " is damaged on the coordinator's disk"};
}

grpc::Status open_output(Controller& controller, uint64_t job, const std::string& path,
                         StoredOutput& output, core::MadeFile& file) {
  // The path is looked up among the job's outputs and never taken for one of the file system's.
  auto stored = controller.store().output(job, path);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) {
    return {grpc::StatusCode::NOT_FOUND, fmt::format("job {} has no output '{}' (yet)", job, path)};
  }
  output = std::move(**stored);
  auto found = core::MadeFile::find(controller.output_folder(job), output.path);
  if (!found || found->size() != output.size) return damaged_output(path);
  file = std::move(*found);
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
