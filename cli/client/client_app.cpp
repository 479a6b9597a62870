#include "cli/client/client_app.h"

#include <cstdio>
#include <utility>

#include "cli/command_line.h"
#include "cli/number_range.h"
#include "cli/peer_options.h"

namespace hyades::cli {

ClientApp::ClientApp(const char* command, const std::string& description)
    : command_(command), app_(description, std::string("hyades ") + command) {
  const char* const group = "The coordinator";
  add_peer_options(app_, options_.peer, group);
  app_.add_option("--patience", options_.later_patience,
                  "seconds to go on trying when a coordinator that was there is gone")
      ->check(in_range(0.0, 1e9))
      ->capture_default_str()
      ->group(group);
}

void ClientApp::give_examples(const std::vector<std::string>& examples, const std::string& more) {
  std::string text = "examples:\n";
  for (const std::string& example : examples) text += "  " + example + "\n";
  if (!more.empty()) text += more + "\n";
  app_.footer(text +
              "exit status: 0 done, 1 it could not be done, 2 wrong arguments, 3 no coordinator "
              "answers, 4 no\n"
              "token or the wrong one, 5 there is no such thing; docs/client.md tells more");
}

std::optional<int> ClientApp::parse(int argc, char** argv) {
  return parse_command_line(app_, argc, argv, kBadArguments);
}

std::unique_ptr<FarmClient> ClientApp::connect() const {
  auto client = FarmClient::open(options_);
  if (const std::string warning = farm::plaintext_warning(options_.peer); !warning.empty()) {
    std::fprintf(stderr, "hyades %s: WARNING: %s\n", command_, warning.c_str());
  }
  if (client) return std::move(*client);
  report({kBadArguments, client.error().message});
  return nullptr;
}

std::unique_ptr<FarmClient> ClientApp::connect_impatiently() const {
  ClientOptions options = options_;
  options.first_patience = 0;
  options.later_patience = 0;
  auto client = FarmClient::open(options);
  return client ? std::move(*client) : nullptr;
}

}  // namespace hyades::cli
