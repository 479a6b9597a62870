#pragma once

namespace hyades::cli {

// The farm's commands for people: argv[0] is the command's word, arguments follow. They return an
// ExitCode (cli/client/failure.h).

int submit_command(int argc, char** argv);
int watch_command(int argc, char** argv);
int fetch_command(int argc, char** argv);

int jobs_command(int argc, char** argv);
int status_command(int argc, char** argv);
int explain_command(int argc, char** argv);
int logs_command(int argc, char** argv);
int trace_command(int argc, char** argv);

int pause_command(int argc, char** argv);
int resume_command(int argc, char** argv);
int cancel_command(int argc, char** argv);
int retry_command(int argc, char** argv);
int delete_command(int argc, char** argv);
int priority_command(int argc, char** argv);

int token_command(int argc, char** argv);
int certs_command(int argc, char** argv);
int audit_command(int argc, char** argv);

int top_command(int argc, char** argv);
int autoscale_command(int argc, char** argv);
int workers_command(int argc, char** argv);
int drain_command(int argc, char** argv);
int quarantine_command(int argc, char** argv);
int release_command(int argc, char** argv);

}  // namespace hyades::cli
