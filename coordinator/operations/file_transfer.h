#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "coordinator/job_store/job_store.h"
#include "core/job/made_file.h"
#include "farm/content_writer.h"

namespace hyades::coordinator {

class AuditLog;
class Controller;

// Files that come in, in pieces, and go out, by whichever door.

/// Begins with a file, or goes on with what is there of it from this caller, and notes that: once
/// for a file, however many pieces it comes in. `log` may be null. `writer` stays null where the
/// whole file is here already. RESOURCE_EXHAUSTED where the caller has as many uploads as allowed
/// (OwnerQuotas). May wait for the disk.
grpc::Status begin_upload(Controller& controller, AuditLog* log, const Caller& caller,
                          const std::string& name, uint64_t size,
                          std::unique_ptr<farm::ContentWriter>& writer);

/// UNAVAILABLE for now: a large file is hashed, for others or with many others.
grpc::Status still_checked();

/// Takes bytes of the caller's file that begin at `offset`; of those that are here already none.
/// The last ones make it whole (writer.offset() is writer.size() then). May wait for the disk.
grpc::Status take_piece(Controller& controller, const Caller& caller, farm::ContentWriter& writer,
                        uint64_t offset, std::span<const std::byte> bytes);

/// Finds the file of a job's output, and what is stored of it. NOT_FOUND, or DATA_LOSS where it is
/// not as it was. May wait for the disk.
grpc::Status open_output(Controller& controller, uint64_t job, const std::string& path,
                         StoredOutput& output, core::MadeFile& file);
/// DATA_LOSS: the file of an output is not as it was.
grpc::Status damaged_output(const std::string& path);

}  // namespace hyades::coordinator
