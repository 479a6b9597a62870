#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// The channels of a picture that `layer` (as a job calls it) means; empty where there is no such
/// layer. They need not be there.
std::vector<std::string> channels_of(std::string_view layer, const Image& picture);

/// A layer to look at: R, G, B of a picture that is not beauty. Light (components, light groups,
/// albedo, variance) as it is, to be tone-mapped (`is_light`); the rest as display values:
/// directions from -1..1, position by its fractions of a unit (10 m) of length, depth from white
/// (nearest) to black (farthest), motion as colour around grey (32 pixels to either end), samples
/// and alpha as grey, ids in colours of their own. The error names a layer that the film does not
/// hold.
struct LayerView {
  Image image;
  bool is_light = true;
};
Result<LayerView> view_layer(const Image& picture, const std::string& layer);

}  // namespace hyades::core
