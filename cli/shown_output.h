#pragma once

#include <optional>
#include <string>

#include "core/job/output_desc.h"

namespace CLI {
class App;
}

namespace hyades::cli {

/// A picture to be written of another one, and how a display shows it.
struct ShownOutput {
  core::OutputDesc output;        ///< its file and its tone map
  std::optional<float> exposure;  ///< stops; nothing: what the other picture says of itself

  /// What is to be written of the picture in the file `of`.
  core::OutputDesc desc(const std::string& of) const;
};

/// Options --output, --tone-map and --exposure.
void declare_shown_output(CLI::App& app, ShownOutput& shown);

}  // namespace hyades::cli
