#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/client/farm_client.h"

namespace hyades::cli {

/// Which of several jobs of one name is meant.
enum class Namesakes {
  none,    ///< none of them: only an id will do
  open,    ///< the only one that has not ended
  failed,  ///< the only one that was cancelled, or of which a frame has failed
  newest,  ///< the one submitted last
};

/// Puts into `id` which job `text` means: its id, or its name. Where several have that name
/// standard error says which was taken, or, where `namesakes` does not tell, it is a wrong
/// argument. Failures name what is near.
Outcome find_job(FarmClient& client, const std::string& text, Namesakes namesakes, uint64_t& id);

/// Puts into `frames` which frames of the job a text of --frames means (parse_frame_list()), in
/// ascending order; none where it is empty. A failure where the job does not have them all.
Outcome select_frames(FarmClient& client, uint64_t id, const std::string& text,
                      std::vector<int32_t>& frames);

/// The jobs that have not ended, and of the newest 200 up to `most` that ended last, the
/// newest first; of one owner, or of all ("").
Outcome list_latest_jobs(FarmClient& client, size_t most, const std::string& owner,
                         std::vector<v1::Job>& jobs);

/// Every job, the newest first: those that have not ended, or all; of one owner, or of all ("").
Outcome list_all_jobs(FarmClient& client, bool ended, const std::string& owner,
                      std::vector<v1::Job>& jobs);

}  // namespace hyades::cli
