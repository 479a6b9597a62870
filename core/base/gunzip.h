#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/base/assets.h"
#include "core/base/bytes.h"
#include "core/base/result.h"

namespace hyades::core {

/// Whether bytes begin as those of a gzip file do (RFC 1952).
bool is_gzip(std::span<const std::byte> bytes);

/// What the bytes of a gzip file unpack to: all of its members, one after the other; zeros after
/// the last are padding. Memory is taken as bytes come out. Errors: damaged or cut short; more than
/// `limit` bytes come out.
Result<Bytes> gunzip(std::span<const std::byte> bytes, size_t limit);

/// Most that a file of `size` bytes may unpack to where nothing else is known: geometry as text or
/// numbers packs to a tenth, seldom to a hundredth.
inline constexpr size_t unpacked_limit(size_t size) { return (size_t{64} << 20) + 256 * size; }

/// The bytes behind `reference`, unpacked where they are a gzip file's (up to unpacked_limit()).
/// Errors name the reference.
Result<Bytes> open_unpacked(AssetResolver& assets, const std::string& reference);

}  // namespace hyades::core
