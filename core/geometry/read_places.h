#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/geometry/point_instancer.h"

namespace hyades::core {

/// About what a copy of an instancer takes while a scene is made, its place and Embree's hierarchy.
inline constexpr size_t kBytesPerCopy = 192;

/// Reads the places of copies: the vertices of a PLY file (text or binary, perhaps packed by gzip),
/// each with x y z, and perhaps `scale`, or scale_x scale_y scale_z, and a rotation qx qy qz qw; or
/// with a matrix m00 m01 m02 m03 m10 ... m23, row by row. Scaled first, then turned, then moved.
/// Errors name the file and the row: numbers that are not finite, a rotation of length 0, a file
/// that is cut short; more than there is memory for (`room` bytes; 0: not known), told before any
/// is taken.
Result<std::shared_ptr<const std::vector<PlaceMatrix>>> read_places(AssetResolver& assets,
                                                                    const std::string& reference,
                                                                    size_t room);

/// A binary file of these places, m00 to m23, that read_places reads back to the last bit.
Bytes places_bytes(std::span<const PlaceMatrix> places);

}  // namespace hyades::core
