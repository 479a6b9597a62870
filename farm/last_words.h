#pragma once

namespace hyades::farm {

/// An exception that nobody catches (no memory, above all) ends the process with one line on
/// standard error, "PROGRAM stops: WHY; ADVICE", and SIGABRT. Both are string literals.
void die_with_words(const char* program, const char* advice);

}  // namespace hyades::farm
