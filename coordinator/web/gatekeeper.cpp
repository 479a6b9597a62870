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
#include "core/base/random_id.h"
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

Gatekeeper::Gatekeeper(Authority& authority, std::string shared_token, bool loopback, bool secure)
    : authority_(authority),
      shared_token_(std::move(shared_token)),
      loopback_(loopback),
      secure_(secure) {
  // Without random numbers no session can be opened: sign() gives nothing.
  const auto half = core::random_id();
  const auto rest = core::random_id();
  if (half && rest) key_ = *half + *rest;
}

grpc::Status Gatekeeper::check(const WebRequest& request, Caller& caller) const {
  if (const grpc::Status site = check_site(request); !site.ok()) return site;
  caller.address = request.address;
  const std::string& shown = request.header("authorization");
  if (shown.empty()) {
    const std::string_view session = find_cookie(request.header("cookie"));
    if (!session.empty() && authority_.guarded()) return admit_session(session, caller);
  }
  return authority_.admit(shown, caller);
}

grpc::Status Gatekeeper::check_site(const WebRequest& request) const {
  const std::string host = small_letters(request.header("host"));
  // Without a token, the only guard is that nobody but this machine gets here; a page that has its
  // own name resolve to 127.0.0.1 would be here, too.
  if (loopback_ && !authority_.guarded() && !host.empty() &&
      !farm::is_loopback(host.find(':') == std::string::npos || host.ends_with(']') ? host + ":80"
                                                                                    : host)) {
    return {grpc::StatusCode::PERMISSION_DENIED,
            fmt::format("'{}' is not a name of this machine: use localhost or 127.0.0.1, or "
                        "make a token ('hyades token create')",
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

// A session is "ID.UNTIL.SIGNATURE": which token has opened it, and until when it lasts (seconds
// since 1970). It ends with the token, too.

std::optional<std::string> Gatekeeper::open_session(const std::string& token,
                                                    grpc::Status& why) const {
  Caller caller;
  why = authority_.guarded()
            ? authority_.admit("Bearer " + token, caller)
            : grpc::Status(grpc::StatusCode::UNAUTHENTICATED, "this coordinator asks for no token");
  if (!why.ok()) return std::nullopt;
  const std::string until = std::to_string(now_seconds() + kSessionSeconds);
  const std::string signature = sign(caller.token_id, until);
  if (signature.empty()) {
    why = {grpc::StatusCode::INTERNAL, "the system gives no random numbers"};
    return std::nullopt;
  }
  return fmt::format("{}{}.{}.{}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}{}", kCookie,
                     caller.token_id, until, signature, kSessionSeconds, secure_ ? "; Secure" : "");
}

std::string Gatekeeper::end_session() const {
  return fmt::format("{}; Path=/; HttpOnly; SameSite=Strict; Max-Age=0", kCookie);
}

grpc::Status Gatekeeper::admit_session(std::string_view session, Caller& caller) const {
  const grpc::Status over = {grpc::StatusCode::UNAUTHENTICATED,
                             "the session is over: sign in again"};
  const size_t first = session.find('.');
  const size_t second = first == std::string_view::npos ? first : session.find('.', first + 1);
  if (second == std::string_view::npos) return over;
  const std::string id(session.substr(0, first));
  const std::string until(session.substr(first + 1, second - first - 1));
  const std::string signature = sign(id, until);
  if (signature.empty() || !same(std::string(session.substr(second + 1)), signature)) return over;
  int64_t seconds = 0;
  std::from_chars(until.data(), until.data() + until.size(), seconds);
  if (now_seconds() >= seconds) return over;
  return authority_.admit_known(id, caller);
}

/// HMAC-SHA-256. Sessions of the shared token are signed with that, so that they outlive the
/// process and end with it; of other tokens only hashes are known, which whoever reads the data
/// folder has, too.
std::string Gatekeeper::sign(const std::string& id, const std::string& until) const {
  const std::string& key = id == kSharedToken ? shared_token_ : key_;
  if (key.empty()) return {};
  const std::string signed_text = "hyades session of " + id + " until " + until;
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
       reinterpret_cast<const unsigned char*>(signed_text.data()), signed_text.size(), digest,
       &size);
  return core::to_hex(std::span(digest, size));
}

}  // namespace hyades::coordinator
