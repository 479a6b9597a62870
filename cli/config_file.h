#pragma once

#include <CLI/CLI.hpp>

namespace hyades::cli {

/// Adds `--config FILE`: a YAML map of the app's options by their names without dashes. What the
/// command line has goes first, then the file, then variables of the environment. To be called when
/// all options that a file may have are there; `app` outlives its parsing. Whatever is wrong in the
/// file (syntax, names that are no options, values that the option refuses) is a CLI::ParseError
/// that begins with FILE:LINE:COLUMN.
void add_config_option(CLI::App& app);

}  // namespace hyades::cli
