#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "cli/address_option.h"
#include "farm/channel.h"

namespace hyades::cli {

/// The options, and variables of the environment, that say where the coordinator is and what it is
/// shown; in the help they stand under `group`.
inline void add_peer_options(CLI::App& app, farm::Peer& peer, const std::string& group) {
  const auto grouped = [&](CLI::Option* option) { option->group(group); };
  // Not by check(): CLI11 2.4 passes over a variable of the environment that fails it.
  const auto set_address = [&peer](const std::string& text) {
    for (const std::string& address : farm::split_addresses(text)) {
      const std::string error = address_error(address);
      if (!error.empty()) throw CLI::ValidationError("--coordinator", error);
    }
    peer.address = text;
  };
  grouped(app.add_option_function<std::string>("--coordinator", set_address,
                                               "HOST:PORT of the coordinator; of several, one of "
                                               "which leads, with commas between")
              ->envname("HYADES_COORDINATOR")
              ->default_str(peer.address));
  grouped(app.add_option("--token-file", peer.token_file, "file with the farm's token")
              ->envname("HYADES_TOKEN_FILE"));
  grouped(app.add_option("--tls-ca", peer.ca_file,
                         "certificate (PEM) of who signed the coordinator's: turns TLS on")
              ->envname("HYADES_TLS_CA"));
  grouped(app.add_option("--tls-cert", peer.cert_file,
                         "certificate (PEM) to show to a coordinator that asks for one")
              ->envname("HYADES_TLS_CERT"));
  grouped(app.add_option("--tls-key", peer.key_file, "its private key (PEM)")
              ->envname("HYADES_TLS_KEY"));
  grouped(app.add_flag("--insecure", peer.insecure, "send plain text also beyond this machine"));
}

}  // namespace hyades::cli
