#pragma once

namespace hyades::cli {

/// `hyades compare a.exr b.exr`: argv[0] is the word "compare", arguments follow. Prints a report
/// (or JSON) to standard output, errors to standard error. Exit status: 0 fine, 1 a tolerance is
/// exceeded, 2 wrong arguments or pictures that cannot be read or compared.
int compare_command(int argc, char** argv);

}  // namespace hyades::cli
