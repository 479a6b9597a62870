#pragma once

#include <cstdint>
#include <string>

#include "cli/client/farm_client.h"

namespace hyades::cli {

/// Puts into `id` which job `text` means: its id, or its name where only one job has it. Failures
/// name what is near.
Outcome find_job(FarmClient& client, const std::string& text, uint64_t& id);

/// Every job, the newest first: those that have not ended, or all; of one owner, or of all ("").
Outcome list_all_jobs(FarmClient& client, bool ended, const std::string& owner,
                      std::vector<v1::Job>& jobs);

}  // namespace hyades::cli
