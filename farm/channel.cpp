#include "farm/channel.h"

#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <absl/synchronization/mutex.h>
#include <fmt/format.h>
#include <grpc/support/log.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

#include "farm/log.h"
#include "farm/small_file.h"
#include "farm/tls_files.h"
#include "farm/wire.h"

namespace hyades::farm {
namespace {

namespace tls = grpc::experimental;

constexpr size_t kShortestToken = 16;
/// How soon certificates that have changed are noticed.
constexpr unsigned kReadAgainSeconds = 2;
/// When a connection over which nothing has come is pinged, and how long the answer may take.
struct Keepalive {
  int after_ms;
  int timeout_ms;
};
constexpr Keepalive kPatient{20'000, 10'000};
/// Coordinators permit pings that are kLeastPingInterval apart.
constexpr Keepalive kSoon{2000, 4000};
static_assert(kSoon.after_ms > kLeastPingInterval.count());

/// A failed assertion ends the process: that has to be seen.
void say_last_words(gpr_log_func_args* line) {
  if (std::string_view(line->message).find("ASSERTION FAILED") == std::string_view::npos) return;
  log(LogLevel::error, fmt::format("{}:{}: {}", line->file, line->line, line->message));
}

/// Keeps gRPC's own lines off standard error: what goes wrong is told in our words, once. Whoever
/// looks for a fault of gRPC sets GRPC_VERBOSITY or GRPC_TRACE, and has them all. Idempotent.
void quiet_grpc() {
  // Debian's library looks for cycles in the order of locks, at each of gRPC's: that costs more
  // than the calls themselves where there are many.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  if (std::getenv("GRPC_VERBOSITY") != nullptr || std::getenv("GRPC_TRACE") != nullptr) return;
  gpr_set_log_function(say_last_words);
}

/// Reads the files again and again; empty names are none.
std::shared_ptr<tls::CertificateProviderInterface> watch(const std::string& ca_file,
                                                         const std::string& cert_file,
                                                         const std::string& key_file) {
  return std::make_shared<tls::FileWatcherCertificateProvider>(key_file, cert_file, ca_file,
                                                               kReadAgainSeconds);
}

core::Error plaintext_error(const std::string& address) {
  return {address +
          " is not this machine: give certificates (TLS), or --insecure to send all as plain text"};
}

}  // namespace

core::Result<std::string> read_token(const std::string& file) {
  if (file.empty()) return std::string();
  auto text = read_small_file(file);
  if (!text) return text;
  std::string token = *text;
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  bool good = token.size() >= kShortestToken;
  for (const char c : token) good &= c > ' ' && c < 127;
  if (!good) {
    return core::Error{file + ": expected one line of at least 16 printable characters, a token"};
  }
  return token;
}

std::vector<std::string> split_addresses(const std::string& text) {
  std::vector<std::string> addresses;
  size_t from = 0;
  for (size_t comma = 0; comma != std::string::npos; from = comma + 1) {
    comma = text.find(',', from);
    addresses.push_back(text.substr(from, comma - from));
  }
  return addresses;
}

bool is_loopback(const std::string& address) {
  const std::string host = address.substr(0, address.rfind(':'));
  return host == "localhost" || host == "[::1]" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

std::string plaintext_warning(const Peer& peer) {
  if (!peer.ca_file.empty() || !peer.insecure) return {};
  std::string beyond;
  for (const std::string& address : split_addresses(peer.address)) {
    if (!is_loopback(address)) beyond += (beyond.empty() ? "" : ", ") + address;
  }
  if (beyond.empty()) return {};
  return "plain text to " + beyond + " (--insecure): whoever listens may read everything" +
         (peer.token_file.empty() ? "" : ", the token too");
}

core::Result<std::shared_ptr<grpc::Channel>> connect(const Peer& peer, Notices notices) {
  quiet_grpc();
  std::shared_ptr<grpc::ChannelCredentials> credentials;
  if (peer.cert_file.empty() != peer.key_file.empty()) {
    return core::Error{"a certificate to show needs its key, and a key its certificate"};
  }
  if (peer.ca_file.empty() && !peer.cert_file.empty()) {
    return core::Error{"a certificate is shown with TLS only: give --tls-ca too"};
  }
  if (!peer.ca_file.empty()) {
    const auto ca = read_certificates(peer.ca_file);
    if (!ca) return ca.error();
    if (!peer.cert_file.empty()) {
      const auto pair = read_key_pair(peer.cert_file, peer.key_file);
      if (!pair) return pair.error();
    }
    tls::TlsChannelCredentialsOptions options;
    options.set_certificate_provider(watch(peer.ca_file, peer.cert_file, peer.key_file));
    options.watch_root_certs();
    if (!peer.cert_file.empty()) options.watch_identity_key_cert_pairs();
    credentials = tls::TlsCredentials(options);
  } else if (is_loopback(peer.address) || peer.insecure) {
    credentials = grpc::InsecureChannelCredentials();
  } else {
    return plaintext_error(peer.address);
  }
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(static_cast<int>(kMaxMessageBytes));
  // A megabyte may be unpacked to a thousand: gRPC looks at the length only then.
  arguments.SetInt(GRPC_ARG_ENABLE_PER_MESSAGE_DECOMPRESSION, 0);
  const Keepalive keepalive = notices == Notices::soon ? kSoon : kPatient;
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, keepalive.after_ms);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, keepalive.timeout_ms);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  // How long one attempt may take: a server that starts again has many handshakes to make.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 3000);
  // Callers wait between their tries themselves (farm/backoff.h), and each try shall be one.
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 500);
  return grpc::CreateCustomChannel(peer.address, credentials, arguments);
}

void prepare(grpc::ClientContext& context, const std::string& token,
             std::chrono::milliseconds timeout) {
  context.AddMetadata(kProtocolKey, std::to_string(kProtocol));
  if (!token.empty()) context.AddMetadata(kTokenKey, "Bearer " + token);
  if (timeout.count() > 0) context.set_deadline(std::chrono::system_clock::now() + timeout);
}

core::Result<Door> open_door(const Listen& listen) {
  quiet_grpc();
  Door door{listen.address, nullptr, {}};
  const bool open = !is_loopback(listen.address) && !listen.insecure;
  if (listen.cert_file.empty() != listen.key_file.empty()) {
    return core::Error{"TLS needs both a certificate and its key"};
  }
  auto token = read_token(listen.token_file);
  if (!token) return token.error();
  door.token = std::move(*token);
  if (listen.cert_file.empty()) {
    if (!listen.ca_file.empty() || !listen.worker_ca_file.empty()) {
      return core::Error{"clients' certificates need TLS: give a certificate and its key"};
    }
    if (open) return plaintext_error(listen.address);
    door.credentials = grpc::InsecureServerCredentials();
    return door;
  }
  if (open && listen.token_file.empty() && !listen.asks_tokens) {
    return core::Error{listen.address +
                       " is not this machine: give a token file, or --insecure to let anybody in"};
  }
  auto pair = read_key_pair(listen.cert_file, listen.key_file);
  if (!pair) return pair.error();
  if (!listen.ca_file.empty() && !listen.worker_ca_file.empty()) {
    return core::Error{
        "--tls-ca asks everybody for a certificate, workers too: leave out --worker-ca"};
  }
  const std::string& ca_file = listen.ca_file.empty() ? listen.worker_ca_file : listen.ca_file;
  if (!ca_file.empty()) {
    if (const auto ca = read_certificates(ca_file); !ca) return ca.error();
  }
  tls::TlsServerCredentialsOptions options(watch(ca_file, listen.cert_file, listen.key_file));
  options.watch_identity_key_cert_pairs();
  if (!ca_file.empty()) options.watch_root_certs();
  options.set_cert_request_type(ca_file.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                : !listen.ca_file.empty()
                                    ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                                    : GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
  door.workers_show = !listen.worker_ca_file.empty();
  door.credentials = tls::TlsServerCredentials(options);
  return door;
}

}  // namespace hyades::farm
