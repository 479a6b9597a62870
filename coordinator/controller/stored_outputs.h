#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/finisher/finish_task.h"
#include "coordinator/job_store/job_store.h"
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

}  // namespace hyades::coordinator
