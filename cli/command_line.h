#pragma once

#include <optional>

#include <CLI/CLI.hpp>

namespace hyades::cli {

/// Reads the command line into what `app` was told. The exit status where it ends the command: 0
/// after --help, or `wrong` after one line on standard error, "hyades COMMAND: what is wrong".
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv, int wrong = 2);

}  // namespace hyades::cli
