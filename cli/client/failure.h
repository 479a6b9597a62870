#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hyades::cli {

/// How the farm's commands end; docs/client.md lists them for scripts.
enum ExitCode {
  kDone = 0,
  kFailed = 1,        ///< the job failed, or what was asked for could not be done
  kBadArguments = 2,  ///< of the command, or of the job's text
  kNoAnswer = 3,      ///< the coordinator cannot be reached
  kRefused = 4,       ///< no token, or the wrong one
  kUnknown = 5,       ///< no such job, frame, worker or file
  kCancelled = 6,     ///< the job was cancelled
  kInterrupted = 130,
};

/// Why something did not work, for good: what the person reads, in one line, and the exit status.
struct Failure {
  ExitCode code = kFailed;
  std::string message;
  std::vector<std::string> missing = {};  ///< SHA-256 in hexadecimal: files to be uploaded first
  bool lines = false;                     ///< the message may have several
  bool damaged = false;                   ///< bytes were not what their digest says
  bool from_start = false;                ///< the other side lacks what it was believed to have
  bool again = false;                     ///< another try is due now
};

/// Nothing where all went well.
using Outcome = std::optional<Failure>;

/// Prints "hyades COMMAND: message" to standard error; the exit status.
int report(const char* command, const Failure& failure);

}  // namespace hyades::cli
