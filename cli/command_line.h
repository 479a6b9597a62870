#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "core/base/result.h"

namespace hyades::cli {

/// Exit status of commands that refuse their arguments or what they read.
inline constexpr int kExitRefused = 2;

/// What is wrong with a command line, in our words; CLI11's where it has others than these.
std::string in_our_words(const CLI::App& app, const CLI::ParseError& error);

/// Reads the command line into what `app` was told. The exit status where it ends the command: 0
/// after --help, or `wrong` after one line on standard error, "hyades COMMAND: what is wrong".
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv,
                                      int wrong = kExitRefused);

/// A line on standard error for each line of `error`, which may tell what a stranger's file says.
/// `path`, which it may name, stays in one line.
void print_error(const core::Error& error, const std::string& path = {});

}  // namespace hyades::cli
