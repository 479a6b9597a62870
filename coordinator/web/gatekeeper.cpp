#include "coordinator/web/gatekeeper.h"

#include <charconv>
#include <chrono>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include "core/base/hash.h"
#include "farm/channel.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kCookie = "hyades_session=";
constexpr int64_t kSessionSeconds = int64_t{30} * 24 * 3600;

int64_t now_seconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// In a time that does not depend on how much of it is right.
bool same(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string small_letters(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// The value of our cookie among those of a Cookie header.
std::string_view find_cookie(std::string_view cookies) {
  while (!cookies.empty()) {
    std::string_view cookie = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(cookies.size(), cookie.size() + 1));
    while (cookie.starts_with(' ')) cookie.remove_prefix(1);
    if (cookie.starts_with(kCookie)) return cookie.substr(kCookie.size());
  }
  return {};
}

bool changes_something(const std::string& method) { return method != "GET"; }

}  // namespace

grpc::Status Gatekeeper::check(const WebRequest& request) const {
  if (const grpc::Status site = check_site(request); !site.ok()) return site;
  if (token_.empty()) return grpc::Status::OK;
  const std::string& shown = request.header("authorization");
  if (!shown.empty()) {
    if (same(shown, "Bearer " + token_)) return grpc::Status::OK;
    return {grpc::StatusCode::UNAUTHENTICATED, "this is not the coordinator's token"};
  }
  if (is_session(request.header("cookie"))) return grpc::Status::OK;
  return {grpc::StatusCode::UNAUTHENTICATED,
          "this coordinator wants its token: sign in, or send 'Authorization: Bearer TOKEN'"};
}

grpc::Status Gatekeeper::check_site(const WebRequest& request) const {
  const std::string host = small_letters(request.header("host"));
  // Without a token, the only guard is that nobody but this machine gets here; a page that has its
  // own name resolve to 127.0.0.1 would be here, too.
  if (loopback_ && token_.empty() && !host.empty() &&
      !farm::is_loopback(host.find(':') == std::string::npos || host.ends_with(']') ? host + ":80"
                                                                                    : host)) {
    return {grpc::StatusCode::PERMISSION_DENIED,
            fmt::format("'{}' is not a name of this machine: use localhost or 127.0.0.1, or start "
                        "the coordinator with --token-file",
                        request.header("host"))};
  }
  const bool other_site = request.header("sec-fetch-site") == "cross-site";
  const std::string& origin = request.header("origin");
  const bool other_origin = changes_something(request.method) && !origin.empty() &&
                            small_letters(origin) != (secure_ ? "https://" : "http://") + host &&
                            // A proxy in front may speak TLS where we do not.
                            !(small_letters(origin) == "https://" + host && !secure_);
  if ((other_site && request.header("sec-fetch-mode") != "navigate") || other_origin) {
    return {grpc::StatusCode::PERMISSION_DENIED, "pages of other sites may not use this one"};
  }
  return grpc::Status::OK;
}

std::optional<std::string> Gatekeeper::open_session(const std::string& token) const {
  if (token_.empty() || !same(token, token_)) return std::nullopt;
  const std::string until = std::to_string(now_seconds() + kSessionSeconds);
  return fmt::format("{}{}.{}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}{}", kCookie, until,
                     sign(until), kSessionSeconds, secure_ ? "; Secure" : "");
}

std::string Gatekeeper::end_session() const {
  return fmt::format("{}; Path=/; HttpOnly; SameSite=Strict; Max-Age=0", kCookie);
}

bool Gatekeeper::is_session(const std::string& cookies) const {
  const std::string_view value = find_cookie(cookies);
  const size_t dot = value.find('.');
  if (dot == std::string_view::npos) return false;
  const std::string until(value.substr(0, dot));
  if (!same(std::string(value.substr(dot + 1)), sign(until))) return false;
  int64_t seconds = 0;
  std::from_chars(until.data(), until.data() + until.size(), seconds);
  return now_seconds() < seconds;
}

/// HMAC-SHA-256 with the token as key, so that a new token ends all sessions.
std::string Gatekeeper::sign(const std::string& text) const {
  const std::string signed_text = "hyades session until " + text;
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  HMAC(EVP_sha256(), token_.data(), static_cast<int>(token_.size()),
       reinterpret_cast<const unsigned char*>(signed_text.data()), signed_text.size(), digest,
       &size);
  return core::to_hex(std::span(digest, size));
}

}  // namespace hyades::coordinator
