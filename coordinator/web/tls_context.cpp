#include "coordinator/web/tls_context.h"

#include <sys/stat.h>

#include <fmt/format.h>
#include <boost/asio/buffer.hpp>

#include "farm/tls_files.h"

namespace hyades::coordinator {
namespace {

namespace ssl = boost::asio::ssl;

/// Another one whenever a file has changed.
std::string stamp_of(const std::string& file) {
  struct stat facts {};
  if (file.empty() || ::stat(file.c_str(), &facts) != 0) return {};
  return fmt::format("{} {} {} {}", facts.st_ino, facts.st_size, facts.st_mtim.tv_sec,
                     facts.st_mtim.tv_nsec);
}

}  // namespace

core::Result<TlsContext::Context> TlsContext::load() const {
  const auto pair = farm::read_key_pair(listen_.cert_file, listen_.key_file);
  if (!pair) return pair.error();
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  boost::system::error_code error;
  context->set_options(
      ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1, error);
  if (!error) context->use_certificate_chain(boost::asio::buffer(pair->cert), error);
  if (!error) context->use_private_key(boost::asio::buffer(pair->key), ssl::context::pem, error);
  if (!error && !listen_.ca_file.empty()) {
    // As over gRPC: who comes shows a certificate that this one has signed.
    const auto ca = farm::read_certificates(listen_.ca_file);
    if (!ca) return ca.error();
    context->add_certificate_authority(boost::asio::buffer(*ca), error);
    if (!error) {
      context->set_verify_mode(ssl::verify_peer | ssl::verify_fail_if_no_peer_cert, error);
    }
  }
  if (error) return core::Error{listen_.cert_file + ": " + error.message()};
  // Or each connection that says nothing keeps what it read and wrote last in.
  ::SSL_CTX_set_mode(context->native_handle(), SSL_MODE_RELEASE_BUFFERS);
  return context;
}

TlsContext::Stamps TlsContext::stamps() const {
  Stamps now;
  for (const std::string& file : {listen_.cert_file, listen_.key_file, listen_.ca_file}) {
    now.push_back(stamp_of(file));
  }
  return now;
}

bool TlsContext::changed() const {
  const Stamps now = stamps();
  const core::MutexLock lock(mutex_);
  return now != taken_;
}

void TlsContext::taken(const Stamps& stamps) {
  const core::MutexLock lock(mutex_);
  taken_ = stamps;
}

}  // namespace hyades::coordinator
