#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

/// What an Attribute directive is for.
enum class Target : uint8_t { shape, light, material, medium, texture };
inline constexpr size_t kTargets = 5;

/// What AttributeBegin keeps and AttributeEnd brings back.
struct GraphicsState {
  Motion to_world;
  std::array<bool, 2> active{true, true};  ///< which of the two transforms directives change
  bool reversed = false;
  const RgbSpace* space = srgb_space();
  size_t material = 0;  ///< index into ParsedScene::materials, where material_name is empty
  std::string material_name;
  int area_light = -1;  ///< index into ParsedScene::area_lights
  std::string inside, outside;
  std::array<std::shared_ptr<const Parameters>, kTargets> attributes;

  /// `own`, then what Attribute directives say about such things.
  Parameters with_attributes(Parameters own, Target target) const {
    const auto& more = attributes[static_cast<size_t>(target)];
    if (more != nullptr) own.insert(own.end(), more->begin(), more->end());
    return own;
  }
};

}  // namespace hyades::core::pbrt
