#include "cli/client/client_app.h"

#include "cli/address_option.h"
#include "cli/command_line.h"

namespace hyades::cli {

ClientApp::ClientApp(const char* command, const std::string& description)
    : command_(command), app_(description, std::string("hyades ") + command) {
  farm::Peer& peer = options_.peer;
  const auto group = [](CLI::Option* option) { option->group("The coordinator"); };
  group(app_.add_option("--coordinator", peer.address, "HOST:PORT of the coordinator")
            ->envname("HYADES_COORDINATOR")
            ->check(address_error)
            ->capture_default_str());
  group(app_.add_option("--token-file", peer.token_file, "file with the farm's token")
            ->envname("HYADES_TOKEN_FILE"));
  group(app_.add_option("--tls-ca", peer.ca_file,
                        "certificate (PEM) of who signed the coordinator's: turns TLS on")
            ->envname("HYADES_TLS_CA"));
  group(app_.add_flag("--insecure", peer.insecure, "send plain text also beyond this machine"));
  group(app_.add_option("--patience", options_.later_patience,
                        "seconds to go on trying when a coordinator that was there is gone")
            ->check(CLI::Range(0.0, 1e9))
            ->capture_default_str());
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
