#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/media/nanovdb_file.h"
#include "core/media/read_vdb.h"

namespace hyades::core {

/// The grid of numbers (Float, Double, Fp4, Fp8, Fp16, FpN) called `name` of the NanoVDB file
/// `bytes` (.nvdb, major version 32, not compressed or by zip or blosc). As with .vdb, voxels that
/// are not active and values below 0 count as 0. NanoVDB's own accessors follow whatever offsets a
/// file states; here all of them are checked. Errors: another version, no such grid (tells which
/// there are), a grid of another type or a level set, nothing active, values that are not finite,
/// damaged bytes, more than kMostVdbBytes.
Result<std::shared_ptr<const VdbGrid<float>>> read_nanovdb_numbers(const Bytes& bytes,
                                                                   const std::string& name);

/// Reads grid `name` of vectors (Vec3f), linear Rec.709, as read_nanovdb_numbers() reads numbers.
Result<std::shared_ptr<const VdbGrid<Rgb>>> read_nanovdb_colors(const Bytes& bytes,
                                                                const std::string& name);

/// The names of a file's grids.
Result<std::vector<std::string>> nanovdb_names(const Bytes& bytes);

}  // namespace hyades::core
