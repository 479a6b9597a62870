#include "coordinator/web/authenticator.h"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/base/wall_clock.h"

namespace hyades::coordinator {
namespace {

constexpr int64_t kSessionSeconds = int64_t{30} * 24 * 3600;

int64_t now_seconds() { return core::wall_ms() / 1000; }

/// The value of a cookie ("name=") among those of a Cookie header.
std::string_view find_cookie(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    std::string_view cookie = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(cookies.size(), cookie.size() + 1));
    while (cookie.starts_with(' ')) cookie.remove_prefix(1);
    if (cookie.starts_with(name)) return cookie.substr(name.size());
  }
  return {};
}

bool changes_something(const std::string& method) { return method != "GET"; }

/// Without its port.
std::string_view name_of(std::string_view host) {
  const size_t bracket = host.starts_with('[') ? host.find(']') : std::string_view::npos;
  const size_t from = bracket == std::string_view::npos ? 0 : bracket + 1;
  return host.substr(0, host.find(':', from));
}

bool is_address(std::string_view name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  if (name.starts_with('[') && name.ends_with(']')) {
    const std::string six(name.substr(1, name.size() - 2));
    return ::inet_pton(AF_INET6, six.c_str(), bytes.data()) == 1;
  }
  return ::inet_pton(AF_INET, std::string(name).c_str(), bytes.data()) == 1;
}

std::string own_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? core::lower_case(name.data()) : "";
}

}  // namespace

Authenticator::Authenticator(Authority& authority, std::vector<std::string> names, bool secure)
    : authority_(authority), names_(std::move(names)), secure_(secure) {
  for (std::string& name : names_) name = core::lower_case(name);
  names_.push_back(own_name());
}

void Authenticator::set_port(uint16_t port) { cookie_ = fmt::format("hyades_session_{}=", port); }

grpc::Status Authenticator::check(const WebRequest& request, const OwnEnd& own,
                                  Caller& caller) const {
  caller.address = request.address;
  if (const grpc::Status site = check_site(request); !site.ok()) return site;
  const std::string& shown = request.header("authorization");
  if (shown.empty()) {
    const std::string_view session = find_cookie(request.header("cookie"), cookie_of(request));
    if (!session.empty() && authority_.guarded()) return admit_session(session, caller);
  }
  return authority_.admit(shown, caller, own);
}

grpc::Status Authenticator::check_site(const WebRequest& request) const {
  const std::string host = core::lower_case(request.header("host"));
  // A page that has its own name resolve to this machine's address would be here without any token,
  // and by a browser that may reach what its site may not.
  if (!authority_.guarded() && !host.empty() && !is_ours(name_of(host))) {
    return {
        grpc::StatusCode::PERMISSION_DENIED,
        fmt::format("'{}' is not known as a name of this machine: use its address or localhost, "
                    "start the coordinator with --http-name {}, or make a token ('hyades token "
                    "create')",
                    request.header("host"), name_of(host))};
  }
  const bool other_site = request.header("sec-fetch-site") == "cross-site";
  const std::string& origin = request.header("origin");
  const bool other_origin = changes_something(request.method) && !origin.empty() &&
                            core::lower_case(origin) != (secure_ ? "https://" : "http://") + host &&
                            // A proxy in front may speak TLS where we do not.
                            !(core::lower_case(origin) == "https://" + host && !secure_);
  if ((other_site && request.header("sec-fetch-mode") != "navigate") || other_origin) {
    return {grpc::StatusCode::PERMISSION_DENIED, "pages of other sites may not use this one"};
  }
  return grpc::Status::OK;
}

bool Authenticator::is_ours(std::string_view name) const {
  if (is_address(name) || name.find('.') == std::string_view::npos) return true;
  for (const char* local : {".local", ".localhost", ".internal", ".home.arpa"}) {
    if (name.ends_with(local)) return true;
  }
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

/// To us, or to a proxy in front of us.
bool Authenticator::came_by_tls(const WebRequest& request) const {
  return secure_ || core::lower_case(request.header("x-forwarded-proto")) == "https";
}

/// "NAME=". With __Host- in front neither another host of the domain nor plain text can set it
/// (RFC 6265bis, 4.1.3.2).
std::string Authenticator::cookie_of(const WebRequest& request) const {
  return (came_by_tls(request) ? "__Host-" : "") + cookie_;
}

std::optional<std::string> Authenticator::open_session(const WebRequest& request,
                                                       const std::string& token,
                                                       grpc::Status& why) {
  Caller caller;
  caller.address = request.address;
  why = authority_.guarded()
            ? authority_.admit("Bearer " + token, caller)
            : grpc::Status(grpc::StatusCode::UNAUTHENTICATED, "this coordinator asks for no token");
  if (!why.ok()) return std::nullopt;
  const auto opened = sessions_.open(caller.token_id, now_seconds() + kSessionSeconds);
  if (!opened) {
    why = {grpc::StatusCode::INTERNAL, "the system gives no random numbers"};
    return std::nullopt;
  }
  authority_.end_session(opened->ended);
  return fmt::format("{}{}; Path=/; HttpOnly; SameSite=Strict; Max-Age={}{}", cookie_of(request),
                     opened->secret, kSessionSeconds, came_by_tls(request) ? "; Secure" : "");
}

std::string Authenticator::end_session(const WebRequest& request) {
  const std::string cookie = cookie_of(request);
  if (const auto ended = sessions_.end(find_cookie(request.header("cookie"), cookie))) {
    authority_.end_session(ended->key);
  }
  return fmt::format("{}; Path=/; HttpOnly; SameSite=Strict; Max-Age=0{}", cookie,
                     came_by_tls(request) ? "; Secure" : "");
}

grpc::Status Authenticator::admit_session(std::string_view secret, Caller& caller) const {
  const auto session = sessions_.find(secret, now_seconds());
  if (!session) {
    return {grpc::StatusCode::UNAUTHENTICATED,
            "the session is over (it was ended, or the coordinator has started again): sign in "
            "again"};
  }
  caller.session = session->key;
  return authority_.admit_known(session->token_id, caller);
}

}  // namespace hyades::coordinator
