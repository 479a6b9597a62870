#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/finisher/finish_task.h"
#include "coordinator/job_store/job_store.h"
#include "core/base/bytes.h"
#include "core/base/machine.h"
#include "core/base/result.h"
#include "core/job/made_file.h"
#include "farm/wire.h"

namespace hyades::coordinator {

/// What is stored of the files that a finisher has made of `frame`, or of all frames up to it.
inline std::vector<StoredOutput> stored_outputs(const std::vector<FinishedFile>& files,
                                                int32_t frame) {
  std::vector<StoredOutput> outputs;
  for (const FinishedFile& file : files) {
    const auto digest = farm::digest_from_hex(file.sha256);
    outputs.push_back(
        {file.path, frame, file.size, digest ? farm::to_wire(*digest) : std::string()});
  }
  return outputs;
}

/// The bytes of an output that lies in `folder`, which finishers may have changed since: an error
/// where it is not as long as it was, or longer than memory bears.
inline core::Result<core::Bytes> read_output(const std::string& folder,
                                             const StoredOutput& output) {
  const auto file = core::MadeFile::find(folder, output.path);
  if (!file) return file.error().in(output.path);
  if (file->size() != output.size) return core::Error{output.path + ": is of another length"};
  auto bytes = file->read_whole(core::usable_memory() / 4);
  if (!bytes) return bytes.error().in(output.path);
  return bytes;
}

}  // namespace hyades::coordinator
