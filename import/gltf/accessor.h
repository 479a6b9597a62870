#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "import/gltf/model.h"

namespace hyades::core {

/// The elements of accessor `index` as floats, one after the other: normalised integers as -1..1 or
/// 0..1, sparse ones put in. `components`: how many an element must have; 0: any. Errors name the
/// accessor; all numbers are finite.
Result<std::vector<float>> read_floats(const GltfModel& model, int index, size_t components);

/// The elements of an accessor of whole numbers.
Result<std::vector<uint32_t>> read_whole(const GltfModel& model, int index, size_t components);

}  // namespace hyades::core
