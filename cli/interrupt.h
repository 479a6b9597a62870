#pragma once

namespace hyades::cli {

/// Exit status after SIGINT or SIGTERM.
inline constexpr int kInterrupted = 130;

/// What a run that was interrupted says last.
inline constexpr const char* kInterruptedWords = "interrupted; continue with --resume\n";

/// From now on the first SIGINT or SIGTERM asks for an orderly end (see interrupted()). Where that
/// takes longer than a second, and at a second signal, the process says kInterruptedWords and ends
/// with kInterrupted at once, wherever its threads are: for programs whose work is safe whenever
/// they are killed.
void watch_for_interrupts();

/// Whether there was a signal.
bool interrupted();

}  // namespace hyades::cli
