#pragma once

#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

enum class Denoiser {
  automatic,  ///< Open Image Denoise where its library is found, else the next
  features,   ///< our own (feature_filter.h)
  oidn,       ///< Open Image Denoise (open_image_denoise.h)
};

/// The denoiser that jobs call `name` ("true": automatic); nothing for "false".
std::optional<Denoiser> find_denoiser(std::string_view name);

/// Channels R, G, B of `picture` (a normalised film, or an EXR of one) without most of their noise;
/// uses variance.R .., albedo.R .., normal.X .. and A where they are there: the more, the better
/// edges stay. Biased: details finer than the noise are lost, and single pixels far brighter than
/// all around them are taken for fireflies. Errors: no R, G, B; no Open Image Denoise where it is
/// asked for.
Result<Image> denoise(const Image& picture, Denoiser denoiser, int threads = 0);

}  // namespace hyades::core
