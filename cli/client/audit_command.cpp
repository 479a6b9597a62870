#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/commands.h"
#include "cli/client/show.h"
#include "cli/duration_option.h"
#include "coordinator/access/token.h"

namespace hyades::cli {
namespace {

std::string who(const v1::AuditEntry& entry) {
  if (entry.token_id().empty()) return entry.role() == v1::ROLE_ADMIN ? "anybody" : "a stranger";
  const std::string name = entry.name().empty() ? "nobody in particular" : entry.name();
  return fmt::format("{} ({}, {})", name, farm::role_name(entry.role()), entry.token_id());
}

void print_entry(const v1::AuditEntry& entry) {
  std::string line = fmt::format("{}  {} at {}: {}", format_time(entry.time_ms()), who(entry),
                                 entry.address(), entry.deed());
  if (!entry.target().empty()) line += " " + entry.target();
  line += ": " + entry.result();
  if (entry.times() > 1) line += fmt::format(", {} times", entry.times());
  if (!entry.detail().empty()) line += " (" + entry.detail() + ")";
  std::printf("%s\n", printable(line).c_str());
}

}  // namespace

int audit_command(int argc, char** argv) {
  ClientApp app("audit", "Prints who did what on the farm, and who was refused.");
  double since = 0;
  bool json = false;
  add_duration(app.app(), "--since", since,
               "only the last 12h, 30d or so (default: all that is kept)");
  app.app().add_flag("--json", json, "print an object a line");
  app.app().footer(
      "examples:\n  hyades audit --since 2h\n  hyades audit --json | grep job.cancel\n"
      "docs/safety.md tells what is kept\n"
      "exit status: 0 done, 2 wrong arguments, 3 no coordinator answers, 4 no token, or not an "
      "admin's");
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  const int64_t since_ms =
      since == 0 ? 0 : coordinator::token_clock_ms() - static_cast<int64_t>(1e3 * since);
  const auto failure = client->audit(since_ms, [&](const v1::AuditEntry& entry) {
    if (json) {
      print_json(to_json(entry));
    } else {
      print_entry(entry);
    }
  });
  return failure ? app.report(*failure) : kDone;
}

}  // namespace hyades::cli
