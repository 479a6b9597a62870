#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::coordinator {

/// What was written or read.
struct BackupCount {
  uint64_t files = 0;
  uint64_t bytes = 0;
  std::vector<std::string> left_out{};  ///< files below outputs and assets that no job can have
};

/// Writes a tar file `to` of what the coordinator of the folder `data` keeps, while it may be
/// running: films first, then the job store, then outputs, assets and the audit log, so that
/// whatever the store says is there. What is lost between them is rendered again. `to` is whole or
/// absent, and for its owner's eyes alone (mode 0600) unless it was there with another mode.
core::Result<BackupCount> write_backup(const std::string& data, const std::string& to);

/// Makes the folder `data`, which must not be there or be empty (but for lost+found), out of a
/// backup, when every file was there and had its digest; a backup that is torn or damaged is
/// refused. A folder that was not there appears as a whole, for its owner alone (mode 0700); one
/// that was, where a disk is mounted say, is filled, the job store last. The folder's starts are
/// counted on by a thousand, so that what workers hold of the coordinator that was lost is not
/// taken for this one's.
core::Result<BackupCount> restore_backup(const std::string& from, const std::string& data);

}  // namespace hyades::coordinator
