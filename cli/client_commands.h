#pragma once

/// The farm's commands for people, in the order of `hyades --help`: of each, in COMMAND(word,
/// help), the word after "hyades" and what that overview says of it. `hyades` and `hyades-client`
/// read these lists. A command's function, WORD_command(), is in a file of cli/client.

/// What people do with jobs of a farm.
#define HYADES_JOB_COMMANDS(COMMAND)                                        \
  COMMAND(submit, "give a job to the farm")                                 \
  COMMAND(jobs, "list the farm's jobs")                                     \
  COMMAND(status, "how a job and its frames are")                           \
  COMMAND(watch, "show how a job gets on, until it has ended")              \
  COMMAND(fetch, "bring a job's finished pictures here")                    \
  COMMAND(logs, "what has happened to a job")                               \
  COMMAND(explain, "why a job does or does not get on")                     \
  COMMAND(trace, "write what was done for a job when, for ui.perfetto.dev") \
  COMMAND(pause, "lease no more units of a job")                            \
  COMMAND(resume, "let a paused job go on")                                 \
  COMMAND(cancel, "end a job")                                              \
  COMMAND(retry, "take up a job's failed frames again")                     \
  COMMAND(priority, "change a job's priority")                              \
  COMMAND(delete, "forget a job that has ended")

/// What people do with a farm and its workers.
#define HYADES_FARM_COMMANDS(COMMAND)                                                    \
  COMMAND(top, "show jobs and workers as they change")                                   \
  COMMAND(workers, "list the farm's workers")                                            \
  COMMAND(drain, "let a worker finish and leave")                                        \
  COMMAND(quarantine, "give a worker no more work")                                      \
  COMMAND(release, "end a worker's quarantine")                                          \
  COMMAND(autoscale, "have a command start and end workers as the queue needs them")     \
  COMMAND(audit, "who did what on the farm")                                             \
  COMMAND(certs, "make certificates: an authority of the farm's own, and what it signs") \
  COMMAND(token, "make, list and revoke the tokens that open the farm")

#define HYADES_CLIENT_COMMANDS(COMMAND) \
  HYADES_JOB_COMMANDS(COMMAND)          \
  HYADES_FARM_COMMANDS(COMMAND)

namespace hyades::cli {

// argv[0] is the command's word, arguments follow. They return an ExitCode (cli/client/failure.h).
#define HYADES_DECLARE(word, help) int word##_command(int argc, char** argv);
HYADES_CLIENT_COMMANDS(HYADES_DECLARE)
#undef HYADES_DECLARE

}  // namespace hyades::cli
