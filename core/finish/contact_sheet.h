#pragma once

#include <span>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

struct ContactPrint {
  std::string name;  ///< written below it: letters (as capitals), digits, '-', '.', '_'
  Image picture;     ///< R, G, B: linear display values, as read_image returns them
};

/// All pictures on one dark sheet in rows of equal height that fill it (see sheet_rows.h), with
/// their names. The sheet is as wide as `columns` pictures of `width` pixels, or as all if they are
/// fewer. Channels R, G, B as display values (encoded: for write_png). Errors: no picture, a
/// picture without R, G, B, more than 1e9 pixels in all.
Result<Image> contact_sheet(std::span<const ContactPrint> prints, int columns, int width);

}  // namespace hyades::core
