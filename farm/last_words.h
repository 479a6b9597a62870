#pragma once

namespace hyades::farm {

/// An exception that nobody catches (no memory, above all) ends the process with one line on
/// standard error, "PROGRAM stops: WHY; ADVICE" (or that as JSON, as set_log has it), and SIGABRT.
/// Both are string literals.
void die_with_words(const char* program, const char* advice);

}  // namespace hyades::farm
