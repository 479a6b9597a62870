#pragma once

#include <cstdlib>
#include <string_view>

#include "core/base/render_class.h"

namespace hyades::test {

/// The class that tests render in: the suite runs those of rays twice, the second time with
/// HYADES_TESTED_CLASS=portable.
inline core::RenderClass tested_class() {
  const char* name = std::getenv("HYADES_TESTED_CLASS");
  const bool portable = name != nullptr && std::string_view(name) == "portable";
  return portable ? core::RenderClass::portable : core::RenderClass::native;
}

}  // namespace hyades::test
