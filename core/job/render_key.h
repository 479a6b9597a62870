#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/job.h"

namespace hyades::core {

/// Hex SHA-256 of everything that decides the pixels of frame `frame`: the resolved job at that
/// frame (not its name, comments, outputs or the frame range, and the crop only where light paths
/// splat), the content hashes of `assets`, and the renderer's version. Parameters are hashed at
/// their values when the shutter opens and at the sample times of its interval, so two frames of a
/// still scene differ only by their seed.
std::string render_key(const Job& job, int32_t frame, const std::vector<AssetRecord>& assets);

}  // namespace hyades::core
