#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/job/color_desc.h"

namespace hyades::core {

/// Makes the numbers of a display of light, by OpenColorIO.
class DisplayTransform {
 public:
  virtual ~DisplayTransform() = default;

  /// R, G, B of linear Rec.709 light become the display's, 0 to 1 where it can show them; other
  /// channels stay. Thread-safe.
  virtual void apply(Image& picture) const = 0;

  /// "display, view, look" in the config's names.
  virtual std::string name() const = 0;

  /// The curve of the display's numbers as its name tells it: "srgb", "bt709" or "" (not known).
  virtual std::string transfer() const = 0;
};

/// The transform that `color` asks for, by the configuration at `path`. Errors name what the
/// configuration has where it has not what is asked for; or say that this program was built without
/// OpenColorIO.
Result<std::shared_ptr<const DisplayTransform>> open_display_transform(const std::string& path,
                                                                       const ColorDesc& color);

}  // namespace hyades::core
