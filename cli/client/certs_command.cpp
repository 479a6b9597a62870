// `hyades certs`: a farm's own certificates.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/client/failure.h"
#include "cli/client_commands.h"
#include "cli/command_line.h"
#include "farm/certificate_maker.h"

namespace hyades::cli {

int certs_command(int argc, char** argv) {
  CLI::App app("Makes a farm's own certificates: an authority, and what it signs.", "hyades certs");
  app.require_subcommand(1);
  std::string folder;
  std::string authority = "Hyades farm";
  int authority_days = 3650;
  farm::CertificateRequest request;

  CLI::App* init = app.add_subcommand("init", "makes an authority: DIR/ca.pem and DIR/ca.key");
  init->add_option("--dir", folder, "folder of the certificates; made if it is missing")
      ->required();
  init->add_option("--name", authority, "what it calls itself")->capture_default_str();
  init->add_option("--days", authority_days, "how long it is good")->capture_default_str();

  CLI::App* issue =
      app.add_subcommand("issue", "makes a certificate: DIR/NAME.pem and DIR/NAME.key");
  issue->add_option("--dir", folder, "folder of the authority")->required();
  issue->add_option("--name", request.name, "of the machine or person; also of the files")
      ->required();
  issue->add_option("--dns", request.dns, "a name by which a server is reached; again for others")
      ->allow_extra_args(false);
  issue->add_option("--ip", request.ips, "an address by which it is; again for others")
      ->allow_extra_args(false);
  issue->add_flag("--server", request.server,
                  "a coordinator shows it (without --dns and --ip it is reached by its name)");
  issue->add_flag("--client", request.client, "a worker or a person shows it");
  issue->add_option("--days", request.days, "how long it is good, at most as its authority")
      ->capture_default_str();
  app.footer(
      "examples:\n"
      "  hyades certs init --dir certs\n"
      "  hyades certs issue --dir certs --name farm --dns farm.example --ip 10.0.0.7 --server\n"
      "  hyades certs issue --dir certs --name node-17 --client\n"
      "Nothing is written over. ca.key signs whatever is wanted: keep it off the machines that "
      "need "
      "only ca.pem. docs/safety.md tells more.\n"
      "exit status: 0 written, 1 not, 2 wrong arguments");
  if (const auto status = parse_command_line(app, argc, argv, kBadArguments)) return *status;
  const bool first = init->parsed();
  const core::Status made = first ? farm::make_authority(folder, authority, authority_days)
                                  : farm::issue_certificate(folder, request);
  if (!made) return report("certs", {kFailed, made.error().message});
  const std::string stem = folder + "/" + (first ? "ca" : request.name);
  std::printf("%s.pem and %s.key are made\n", stem.c_str(), stem.c_str());
  return kDone;
}

}  // namespace hyades::cli
