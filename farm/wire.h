#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/hash.h"
#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/film_info.h"
#include "core/film/unit.h"
#include "hyades/v1/common.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::farm {

// The wire's messages and the core's structs. What comes from the wire is checked: these functions
// accept nothing that the core's types cannot hold.

/// The version of the wire that this program speaks, and the oldest it understands (docs/wire.md).
inline constexpr uint32_t kProtocol = 2;
inline constexpr uint32_t kOldestProtocol = 2;

/// The most files in a FindMissingRequest.
inline constexpr size_t kMostFilesAsked = 10'000;

/// The most bytes of data in a Chunk.
inline constexpr uint64_t kMaxChunkBytes = uint64_t{1} << 20U;
/// The most bytes of a message that names a job's files, or goes to a worker.
inline constexpr uint64_t kMaxMessageBytes = uint64_t{16} << 20U;
/// The most bytes of other requests.
inline constexpr uint64_t kMaxRequestBytes = uint64_t{64} << 10U;
/// The most bytes of a WorkerMessage without its film.
inline constexpr uint64_t kMaxWorkerTalkBytes = uint64_t{1} << 20U;
/// The most bytes of an UploadPart: a chunk and what goes with it.
inline constexpr uint64_t kMaxPartBytes = kMaxChunkBytes + (uint64_t{1} << 10U);
/// The most bytes of a WorkerMessage, which may hold a film.
inline constexpr uint64_t kMaxResultBytes = uint64_t{256} << 20U;

/// The most bytes of a text that is shown to people; longer ones are cut.
inline constexpr size_t kMaxTextBytes = 4000;

v1::PixelRect to_wire(const core::PixelRect& rect);
v1::Unit to_wire(const core::Unit& unit);
std::string to_wire(const core::Sha256& digest);
v1::FilmHeader to_wire(const core::FilmInfo& info);

/// An error where it is empty, or a side is longer than 2^24 pixels.
core::Result<core::PixelRect> from_wire(const v1::PixelRect& rect);
/// An error where the tile is not one, or the batches are none or more than a job can have.
core::Result<core::Unit> from_wire(const v1::Unit& unit);
/// An error where it has not 32 bytes.
core::Result<core::Sha256> digest_from_wire(const std::string& bytes);
core::Result<core::FilmInfo> from_wire(const v1::FilmHeader& header);

/// Hexadecimal digits of a digest as it travels, whatever its length.
std::string hex_from_wire(const std::string& bytes);

/// `text` as a message may hold it for people: cut to kMaxTextBytes, and with '?' for what is not
/// UTF-8 (a message with such a string could not be read by anybody).
std::string wire_text(std::string_view text);

/// 32 bytes from 64 hexadecimal digits, as Film::digest and AssetRecord give them.
core::Result<core::Sha256> digest_from_hex(const std::string& hex);

}  // namespace hyades::farm
