#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/finish/display_transform.h"
#include "core/image/image.h"
#include "core/image/tone_map.h"
#include "core/image/write_image.h"
#include "core/job/job.h"
#include "core/job/output_names.h"

namespace hyades::core {

/// Name of the text in an EXR's header that says with how many stops its job shows it; missing: 0.
inline constexpr const char* kExposureText = "hyades.exposure";

enum class PictureFormat { exr, png, jpeg, tiff };

/// The format that `file`'s ending means (.exr, .png, .jpg, .jpeg, .tif, .tiff; upper case too).
/// The error lists the endings.
Result<PictureFormat> picture_format(std::string_view file);

/// Where `output` goes for `frame`: its file below `folder` (unless absolute), with the frame
/// number in place of # (core/job/output_path.h).
std::string output_path(const OutputDesc& output, const std::string& folder, int32_t frame);

/// The channels of `layers` (names of layer_names()) out of a normalised film, under standard
/// names, in the order of the list: beauty R G B, alpha A, depth "depth.Z", albedo "albedo.R", ...,
/// normal "normal.X", ..., variance "variance.R", ..., samples "samples.N". No layers: beauty
/// and, where there, alpha. The error names a layer that the film does not hold.
Result<Image> select_layers(const Image& normalised, std::span<const std::string> layers);

/// Beauty as display values R, G, B: tone-mapped over black, or, where `transparent`, with straight
/// alpha "A" and colour divided by it before the curve. Film colour is premultiplied by alpha where
/// the environment is invisible to the camera; where it is visible its light is in the colour and
/// is lost with alpha 0.
Result<Image> display_picture(const Image& normalised, ToneCurve curve, float exposure,
                              bool transparent);

/// A layer of a normalised film as display values R, G, B (view_layer); light is tone-mapped.
Result<Image> display_layer(const Image& normalised, const std::string& layer, ToneCurve curve,
                            float exposure);

/// Whether a output for displays shows beauty, not another layer.
inline bool shows_beauty(const OutputDesc& output) {
  return output.layers.empty() || output.layers.front() == "beauty";
}

/// Beauty as display values R, G, B and A, by `display` in place of a curve.
Result<Image> display_picture(const Image& normalised, const DisplayTransform& display,
                              float exposure, bool transparent);

Result<Image> display_layer(const Image& normalised, const std::string& layer,
                            const DisplayTransform& display, float exposure);

/// Writes one output of a job from a normalised film (Film::normalised()) to `path`, in the format
/// of output.file. Folders that miss are made; the file is complete or absent. Metadata go into
/// its header, and for displays also how light became its numbers ("hyades.display").
/// `display`: what makes pictures for displays in place of output.tone_map.
Status write_output(const OutputDesc& output, const Image& normalised, const std::string& path,
                    const ImageMetadata& metadata = {}, const DisplayTransform* display = nullptr);

}  // namespace hyades::core
