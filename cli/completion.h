#pragma once

namespace hyades::cli {

/// `hyades completion SHELL`: prints a script that completes the command's words in bash, zsh or
/// fish. argv[0] is the word "completion". Exit status: 0, or 2 where the shell is not one of them.
int completion_command(int argc, char** argv);

}  // namespace hyades::cli
