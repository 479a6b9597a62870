#include "coordinator/notify/hook.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <utility>

#include <curl/curl.h>
#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/public_address.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostWaiting = 1000;
constexpr long kConnectSeconds = 10;
constexpr int kMostRedirects = 3;
constexpr long kTooManyRequests = 429;

size_t ignore(char*, size_t size, size_t count, void*) { return size * count; }

/// libcurl's own state, made once before any thread needs it.
void prepare_library() {
  static const auto ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  (void)ready;
}

/// Without what may be secret in it: the path of a chat server's hook is its key.
std::string shown(const std::string& url) {
  const size_t host = url.find("://") + 3;
  return url.substr(0, url.find('/', host)) + "/...";
}

/// One piece of `url`; empty where it has none.
std::string part_of(const std::string& url, CURLUPart part) {
  const std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> parsed(curl_url(), curl_url_cleanup);
  char* text = nullptr;
  if (!parsed || curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK ||
      curl_url_get(parsed.get(), part, &text, CURLU_DEFAULT_PORT) != CURLUE_OK) {
    return {};
  }
  const std::unique_ptr<char, decltype(&curl_free)> owned(text, curl_free);
  return text;
}

/// "https://host:443"
std::string origin_of(const std::string& url) {
  return part_of(url, CURLUPART_SCHEME) + "://" + part_of(url, CURLUPART_HOST) + ":" +
         part_of(url, CURLUPART_PORT);
}

/// Whether a URL says itself that it is of this machine or a private network.
bool names_private_address(const std::string& url) {
  std::string host = part_of(url, CURLUPART_HOST);
  if (core::lower_case(host) == "localhost") return true;
  if (host.starts_with('[')) host = host.substr(1, host.find_first_of("]%") - 1);
  sockaddr_in ipv4{};
  sockaddr_in6 ipv6{};
  return ::inet_pton(AF_INET, host.c_str(), &ipv4.sin_addr) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), &ipv6.sin6_addr) == 1;
}

/// Called with what a host's name has been resolved to.
curl_socket_t open_public(void* /*hook*/, curlsocktype /*purpose*/, curl_sockaddr* to) {
  if (!farm::is_public_address(to->addr)) return CURL_SOCKET_BAD;
  return ::socket(to->family, to->socktype | SOCK_CLOEXEC, to->protocol);
}

/// A proxy resolves names by itself, and is whoever runs the farm has chosen.
bool has_proxy() {
  for (const char* name : {"http_proxy", "https_proxy", "HTTPS_PROXY", "all_proxy", "ALL_PROXY"}) {
    if (const char* proxy = std::getenv(name); proxy != nullptr && *proxy != '\0') return true;
  }
  return false;
}

struct Reply {
  long status = 0;
  std::string location;  ///< where it sends us; empty: nowhere
  std::string error;     ///< why there is no answer; empty: there is one
};

Reply post_once(const Hook::Options& options, const std::string& url, const std::string& message) {
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(curl_easy_init(),
                                                                 curl_easy_cleanup);
  if (!curl) return {0, {}, "no memory"};
  const std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> headers(
      curl_slist_append(nullptr, "Content-Type: application/json"), curl_slist_free_all);
  CURL* call = curl.get();
  curl_easy_setopt(call, CURLOPT_URL, url.c_str());
  curl_easy_setopt(call, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(call, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(call, CURLOPT_POSTFIELDS, message.c_str());
  curl_easy_setopt(call, CURLOPT_POSTFIELDSIZE, static_cast<long>(message.size()));
  curl_easy_setopt(call, CURLOPT_USERAGENT, "Hyades");
  curl_easy_setopt(call, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(call, CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
  curl_easy_setopt(call, CURLOPT_TIMEOUT, static_cast<long>(options.timeout.count()));
  curl_easy_setopt(call, CURLOPT_WRITEFUNCTION, ignore);
  const bool only_public =
      !options.may_be_private && !names_private_address(options.url) && !has_proxy();
  if (only_public) curl_easy_setopt(call, CURLOPT_OPENSOCKETFUNCTION, open_public);
  const CURLcode done = curl_easy_perform(call);
  if (done == CURLE_COULDNT_CONNECT && only_public) {
    return {0, {}, "nobody answers at a public address (for a private one: --notify-private)"};
  }
  if (done != CURLE_OK) return {0, {}, curl_easy_strerror(done)};
  Reply reply;
  curl_easy_getinfo(call, CURLINFO_RESPONSE_CODE, &reply.status);
  const char* location = nullptr;
  curl_easy_getinfo(call, CURLINFO_REDIRECT_URL, &location);
  if (location != nullptr) reply.location = location;
  return reply;
}

}  // namespace

core::Status Hook::check(const std::string& url) {
  const bool web = url.starts_with("http://") || url.starts_with("https://");
  if (web && url.size() > url.find("://") + 3) return {};
  return core::Error{fmt::format("'{}': expected a URL, http:// or https://", url)};
}

Hook::Hook(Options options) : options_(std::move(options)) {
  prepare_library();
  thread_ = std::thread([this] { run(); });
}

Hook::~Hook() {
  {
    const core::MutexLock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Hook::post(std::string message) {
  bool dropped = false;
  {
    const core::MutexLock lock(mutex_);
    dropped = waiting_.size() >= kMostWaiting;
    if (dropped) waiting_.pop_front();
    waiting_.push_back(std::move(message));
  }
  wake_.notify_all();
  if (dropped) options_.tell(shown(options_.url) + ": a message is given up: too many wait");
}

void Hook::run() {
  core::MutexLock lock(mutex_);
  for (;;) {
    while (!stop_ && waiting_.empty()) wake_.wait(mutex_);
    if (stop_) return;
    const std::string message = std::move(waiting_.front());
    waiting_.pop_front();
    const auto give_up = Clock::now() + options_.give_up;
    for (auto wait = options_.first_wait;; wait = std::min(wait * 2, options_.longest_wait)) {
      lock.unlock();
      std::string why;
      const Answer answer = try_once(message, why);
      const bool over = answer == Answer::refused || Clock::now() + wait > give_up;
      if (answer != Answer::taken && over) {
        options_.tell(fmt::format("{}: a message is given up: {}", shown(options_.url), why));
      }
      lock.lock();
      if (answer == Answer::taken || over) break;
      const auto again = Clock::now() + wait;
      while (!stop_ && Clock::now() < again) wake_.wait_until(mutex_, again);
      if (stop_) return;
    }
  }
}

Hook::Answer Hook::try_once(const std::string& message, std::string& why) const {
  std::string url = options_.url;
  for (int redirects = 0; redirects <= kMostRedirects; ++redirects) {
    const Reply reply = post_once(options_, url, message);
    why = reply.error;
    if (!why.empty()) return Answer::again;
    if (reply.status >= 200 && reply.status < 300) return Answer::taken;
    why = fmt::format("the other side answers {}", reply.status);
    if (reply.location.empty()) {
      const bool later = reply.status == kTooManyRequests || reply.status >= 500;
      return later ? Answer::again : Answer::refused;
    }
    if (origin_of(reply.location) != origin_of(options_.url)) {
      why = "it has moved to " + origin_of(reply.location) + ": name that one if it is right";
      return Answer::refused;
    }
    url = reply.location;
  }
  why = "it sends from one place to the next";
  return Answer::again;
}

}  // namespace hyades::coordinator
