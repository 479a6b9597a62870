#pragma once

namespace hyades::cli {

/// `hyades merge a.exr b.exr ... -o c.exr`: argv[0] is the word "merge", arguments follow. Joins
/// film EXRs of one picture; the result does not depend on their order. Exit status: 0 fine, 2
/// wrong arguments, files that cannot be read or written, or films that do not fit (the message
/// says which file and why; nothing is written then).
int merge_command(int argc, char** argv);

}  // namespace hyades::cli
