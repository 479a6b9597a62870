#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/film/film.h"
#include "core/film/film_info.h"
#include "core/finish/display_transform.h"
#include "core/job/job.h"

namespace hyades::core {

/// Writes all `outputs` of a frame below `folder`, each complete or absent, with what `info` says
/// in the headers that have room for it. Returns their paths, in the same order.
/// `display`: as in write_output().
Result<std::vector<std::string>> write_outputs(std::span<const OutputDesc> outputs,
                                               const std::string& folder, const FilmInfo& info,
                                               const Film& film,
                                               const DisplayTransform* display = nullptr);

}  // namespace hyades::core
