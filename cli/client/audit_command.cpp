#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "cli/duration_option.h"
#include "coordinator/access/audit_chain.h"
#include "coordinator/access/token.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"

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
  std::printf("%s\n", core::printable(line).c_str());
}

/// Of lines that are not as they should be; the rest are counted.
constexpr uint64_t kMostTold = 1000;

std::string short_name(const std::string& name) {
  constexpr size_t kLong = 100;
  return core::printable(name.size() > kLong ? name.substr(0, kLong) + "..." : name);
}

/// Follows the chains of the logs, and looks for digests that were noted before.
class Verification {
 public:
  explicit Verification(std::vector<std::string> noted) : noted_(std::move(noted)) {}

  void add(const v1::AuditEntry& entry) {
    const std::string wrong = chains_.add(entry);
    if (const auto end = chains_.ends().find(entry.log()); end != chains_.ends().end()) {
      std::erase(noted_, end->second.last);
    }
    if (wrong.empty() || ++broken_ > kMostTold) return;
    std::printf("%s: the entry of %s, %s, %s\n", short_name(entry.log()).c_str(),
                format_time(entry.time_ms()).c_str(), short_name(entry.deed()).c_str(),
                wrong.c_str());
  }

  /// Tells what there is; whether all is as it should be.
  bool report() const {
    if (broken_ > kMostTold) {
      std::printf("... and %s more\n", core::format_count(broken_ - kMostTold).c_str());
    }
    for (const auto& [log, end] : chains_.ends()) {
      std::string line = log + ": " + core::counted(end.entries, "line");
      if (end.entries > 0) line += ", last " + end.last;
      if (!end.first.empty()) line += ", the oldest are gone";
      // As a coordinator of before there were chains wrote them, or somebody who took them out.
      if (end.bare > 0) {
        line += fmt::format(
            "; {} of them hold{} no digest: nothing tells whether they are as they "
            "were written",
            end.bare, end.bare == 1 ? "s" : "");
      }
      std::printf("%s\n", line.c_str());
    }
    for (const std::string& digest : noted_) {
      std::printf("no entry has the digest %s\n", core::printable(digest).c_str());
    }
    return broken_ == 0 && noted_.empty();
  }

 private:
  std::vector<std::string> noted_;  ///< that were not met yet
  coordinator::AuditChains chains_;
  uint64_t broken_ = 0;
};

}  // namespace

int audit_command(int argc, char** argv) {
  ClientApp app("audit", "Prints who did what on the farm, and who was refused.");
  double since = 0;
  bool json = false;
  bool verify = false;
  std::vector<std::string> noted;
  add_duration(app.app(), "--since", since,
               "only the last 12h, 30d or so (default: all that is kept)");
  app.app().add_flag("--json", json, "print an object a line");
  auto* verifies =
      app.app().add_flag("--verify", verify,
                         "tell whether any entry was changed, left out or put in, and each log's "
                         "last digest");
  app.app()
      .add_option("--noted", noted,
                  "with --verify: this digest, which it told before, must be there")
      ->needs(verifies)
      ->type_name("DIGEST");
  app.app().footer(
      "examples:\n  hyades audit --since 2h\n  hyades audit --json | grep job.cancel\n"
      "  hyades audit --verify --noted 5891b5b5...\n"
      "docs/safety.md tells what is kept\n"
      "exit status: 0 done, 1 an entry is not as it was written, 2 wrong arguments, 3 no "
      "coordinator answers, 4 no token, or not an "
      "admin's");
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  const int64_t since_ms = since == 0 ? 0 : core::wall_ms() - static_cast<int64_t>(1e3 * since);
  Verification verification(noted);
  const auto failure = client->audit(since_ms, [&](const v1::AuditEntry& entry) {
    if (verify) {
      verification.add(entry);
    } else if (json) {
      print_json(to_json(entry));
    } else {
      print_entry(entry);
    }
  });
  if (failure) return app.report(*failure);
  return verify && !verification.report() ? kFailed : kDone;
}

}  // namespace hyades::cli
