#pragma once

/// The farm's commands for people, in the order of `hyades --help`: of each, in COMMAND(word,
/// about, help), the word after "hyades", what it wants the name of (job, worker or none), and what
/// that overview says of it. `hyades` and `hyades-client`
/// read these lists. A command's function, WORD_command(), is in a file of cli/client.

/// What people do with jobs of a farm.
#define HYADES_JOB_COMMANDS(COMMAND)                                             \
  COMMAND(submit, none, "give a job to the farm")                                \
  COMMAND(jobs, none, "list the farm's jobs")                                    \
  COMMAND(status, job, "how a job and its frames are")                           \
  COMMAND(watch, job, "show how a job gets on, until it has ended")              \
  COMMAND(fetch, job, "bring a job's finished pictures here")                    \
  COMMAND(logs, job, "what has happened to a job")                               \
  COMMAND(explain, job, "why a job does or does not get on")                     \
  COMMAND(trace, job, "write what was done for a job when, for ui.perfetto.dev") \
  COMMAND(pause, job, "lease no more units of a job")                            \
  COMMAND(resume, job, "let a paused job go on")                                 \
  COMMAND(cancel, job, "end a job")                                              \
  COMMAND(retry, job, "render a job's failed frames again")                      \
  COMMAND(priority, job, "change a job's priority")                              \
  COMMAND(delete, job, "forget a job that has ended")

/// What people do with a farm and its workers.
#define HYADES_FARM_COMMANDS(COMMAND)                                                          \
  COMMAND(top, none, "show jobs and workers as they change")                                   \
  COMMAND(workers, none, "list the farm's workers")                                            \
  COMMAND(drain, worker, "let a worker finish and leave")                                      \
  COMMAND(quarantine, worker, "give a worker no more work")                                    \
  COMMAND(release, worker, "end a worker's quarantine")                                        \
  COMMAND(autoscale, none, "have a command start and end workers as the queue needs them")     \
  COMMAND(audit, none, "who did what on the farm")                                             \
  COMMAND(certs, none, "make certificates: an authority of the farm's own, and what it signs") \
  COMMAND(token, none, "make, list and revoke the tokens that open the farm")

#define HYADES_CLIENT_COMMANDS(COMMAND) \
  HYADES_JOB_COMMANDS(COMMAND)          \
  HYADES_FARM_COMMANDS(COMMAND)

namespace hyades::cli {

// argv[0] is the command's word, arguments follow. They return an ExitCode (cli/client/failure.h).
#define HYADES_DECLARE(word, about, help) int word##_command(int argc, char** argv);
HYADES_CLIENT_COMMANDS(HYADES_DECLARE)
#undef HYADES_DECLARE

}  // namespace hyades::cli
