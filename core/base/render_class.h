#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace hyades::core {

/// By which arithmetic rays meet surfaces.
enum class RenderClass : uint8_t {
  native,    ///< Embree: the fastest on processors; bits differ between their makers
  portable,  ///< our own hierarchies: the same bits on every processor and device
};

/// By RenderClass: what jobs call it.
inline const std::array<std::string, 2> kRenderClassNames = {"native", "portable"};

}  // namespace hyades::core
