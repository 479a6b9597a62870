#pragma once

#include <memory>
#include <optional>
#include <string>

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

  /// Exit status where the arguments end the command (they are wrong, or --help).
  std::optional<int> parse(int argc, char** argv);

  /// The coordinator; nothing, and a message, where certificates or tokens cannot be read.
  std::unique_ptr<FarmClient> connect() const;

  int report(const Failure& failure) const { return cli::report(command_, failure); }

 private:
  const char* command_;
  CLI::App app_;
  ClientOptions options_;
};

}  // namespace hyades::cli
