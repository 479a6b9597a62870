#pragma once

#include <ctime>
#include <string>

#include "core/base/result.h"

namespace hyades::cli {

/// A moment as people write it, Unix seconds: "18:00" (the next one after `now`, local time),
/// "2026-03-01T18:00" (local time) or "2026-03-01T18:00:00Z". The error says what was expected.
core::Result<std::time_t> parse_moment(const std::string& text, std::time_t now);

}  // namespace hyades::cli
