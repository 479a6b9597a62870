#include "cli/client/client_app.h"

#include "cli/command_line.h"
#include "cli/peer_options.h"

namespace hyades::cli {

ClientApp::ClientApp(const char* command, const std::string& description)
    : command_(command), app_(description, std::string("hyades ") + command) {
  const char* const group = "The coordinator";
  add_peer_options(app_, options_.peer, group);
  app_.add_option("--patience", options_.later_patience,
                  "seconds to go on trying when a coordinator that was there is gone")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str()
      ->group(group);
}

std::optional<int> ClientApp::parse(int argc, char** argv) {
  return parse_command_line(app_, argc, argv, kBadArguments);
}

std::unique_ptr<FarmClient> ClientApp::connect() const {
  auto client = FarmClient::open(options_);
  if (client) return std::move(*client);
  report({kBadArguments, client.error().message});
  return nullptr;
}

}  // namespace hyades::cli
