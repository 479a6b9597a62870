#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/client/farm_client.h"

namespace hyades::cli {

/// The command line of one of the farm's commands: the options that all have (where the coordinator
/// is, how to get in), and the way to it.
class ClientApp {
 public:
  /// `command`: the word after "hyades".
  ClientApp(const char* command, const std::string& description);

  CLI::App& app() { return app_; }
  const char* command() const { return command_; }
  /// HOST:PORT of the coordinator.
  const std::string& address() const { return options_.peer.address; }

  /// What --help ends with: `examples`, one a line, and the exit statuses that most commands have;
  /// `more` is said between them.
  void give_examples(const std::vector<std::string>& examples, const std::string& more = {});

  /// Exit status where the arguments end the command (they are wrong, or --help).
  std::optional<int> parse(int argc, char** argv);

  /// The coordinator; nothing, and a message, where certificates or tokens cannot be read.
  std::unique_ptr<FarmClient> connect() const;

  /// Another connection after that one, whose calls are tried once.
  std::unique_ptr<FarmClient> connect_impatiently() const;

  int report(const Failure& failure) const { return cli::report(command_, failure); }

 private:
  const char* command_;
  CLI::App app_;
  ClientOptions options_;
};

}  // namespace hyades::cli
