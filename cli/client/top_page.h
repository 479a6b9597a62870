#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::cli {

/// The farm at one moment.
struct FarmNow {
  std::vector<v1::Job> jobs;  ///< that have not ended
  std::vector<v1::Worker> workers;
  int64_t time_ms = 0;  ///< since 1970, UTC
};

/// What `hyades top` shows: lines of at most `width` columns, at most `height` of them. Jobs that
/// run come first, then by priority; workers by what they do. Lines that do not fit are counted.
/// Colours are ANSI's, where `colors`.
std::vector<std::string> top_page(const FarmNow& now, const std::string& coordinator, int width,
                                  int height, bool colors);

}  // namespace hyades::cli
