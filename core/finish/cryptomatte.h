#pragma once

#include <span>
#include <string>

#include "core/film/film.h"
#include "core/image/image.h"
#include "core/image/write_image.h"

namespace hyades::core {

/// How many ids of a pixel a Cryptomatte holds: the usual six, two to a group of four channels.
inline constexpr int kCryptomatteRanks = 6;

/// Adds the channels of the film's ids to its picture (Film::normalised): "object_id.ID", the id of
/// the object that covers most of a pixel (0: none), and the Cryptomatte (Friedman and Jones 2015,
/// specification 1.2.0) "CryptoObject00.R" ... "CryptoObject02.A": pairs of id and coverage,
/// largest first; the same of materials. Coverage is the share of the pixel's samples that met the
/// id first, of those that count by the pixel's filter.
void add_id_channels(const Film& film, Image& picture);

/// What a file with any of these layers says of them: the names behind the ids.
ImageMetadata cryptomatte_metadata(const Film& film, std::span<const std::string> layers);

}  // namespace hyades::core
