#pragma once

#include <string>

#include "core/base/assets.h"
#include "core/job/job.h"
#include "core/job/source.h"

namespace hyades::core {

/// Reads a job: syntax, `include:` and `like:` resolved, every key checked (unknown keys with a
/// suggestion, types, ranges, duplicate keys, dangling names, missing files through `assets`).
/// All complaints land in `diagnostics`; the job is usable only if there are none. Hostile text
/// (alias bombs, cyclic includes, deep nesting, absurd numbers) is refused within bounded time and
/// memory.
Job parse_job(const std::string& text, const std::string& file_name, AssetResolver& assets,
              Diagnostics& diagnostics);

}  // namespace hyades::core
