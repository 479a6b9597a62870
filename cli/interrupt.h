#pragma once

#include <string>

namespace hyades::cli {

/// Exit status after SIGINT or SIGTERM.
inline constexpr int kInterrupted = 130;

/// From now on the first SIGINT or SIGTERM asks for an orderly end (see interrupted()). Where that
/// takes longer than a second, and at a second signal, the process says interrupted_words() and
/// ends with kInterrupted at once, wherever its threads are: for programs whose work is safe
/// whenever they are killed.
void watch_for_interrupts();

/// What a run that was interrupted says last, a line; "interrupted" before the first call. At most
/// 199 bytes of `words` are kept. For one thread.
void set_interrupted_words(const std::string& words);
const char* interrupted_words();

/// Whether there was a signal.
bool interrupted();

}  // namespace hyades::cli
