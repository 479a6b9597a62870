#pragma once

#include <functional>
#include <string>

#include "cli/shown_output.h"
#include "cli/written_file.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::cli {

/// Changes a picture that was read, and what is to be written of it. Its error is told with the
/// picture's name.
using PictureChange = std::function<core::Status(core::Image&, core::OutputDesc&)>;

/// Reads the picture in the file `input`, has it changed and writes it as `shown` and `written`
/// say; the file that is read is not replaced. Errors go to standard error, with the words
/// `command`
/// ("hyades convert"). Exit status: 0 fine, kExitRefused.
int rewrite_picture(const char* command, const std::string& input, const ShownOutput& shown,
                    const WrittenFile& written, const PictureChange& change);

}  // namespace hyades::cli
