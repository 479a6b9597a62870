#include "coordinator/notify/hook.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <curl/curl.h>
#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostWaiting = 1000;
constexpr long kConnectSeconds = 10;
constexpr long kMostRedirects = 3;
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
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Hook::post(std::string message) {
  bool dropped = false;
  {
    const std::lock_guard lock(mutex_);
    dropped = waiting_.size() >= kMostWaiting;
    if (dropped) waiting_.pop_front();
    waiting_.push_back(std::move(message));
  }
  wake_.notify_all();
  if (dropped) options_.tell(shown(options_.url) + ": a message is given up: too many wait");
}

void Hook::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
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
      wake_.wait_for(lock, wait, [&] { return stop_; });
      if (stop_) return;
    }
  }
}

Hook::Answer Hook::try_once(const std::string& message, std::string& why) const {
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> curl(curl_easy_init(),
                                                                 curl_easy_cleanup);
  if (!curl) {
    why = "no memory";
    return Answer::again;
  }
  const std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> headers(
      curl_slist_append(nullptr, "Content-Type: application/json"), curl_slist_free_all);
  CURL* call = curl.get();
  curl_easy_setopt(call, CURLOPT_URL, options_.url.c_str());
  curl_easy_setopt(call, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(call, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(call, CURLOPT_POSTFIELDS, message.c_str());
  curl_easy_setopt(call, CURLOPT_POSTFIELDSIZE, static_cast<long>(message.size()));
  curl_easy_setopt(call, CURLOPT_USERAGENT, "Hyades");
  curl_easy_setopt(call, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(call, CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(call, CURLOPT_MAXREDIRS, kMostRedirects);
  // Else a place that has moved is asked for a page, and the message is lost.
  curl_easy_setopt(call, CURLOPT_POSTREDIR, long{CURL_REDIR_POST_ALL});
  curl_easy_setopt(call, CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
  curl_easy_setopt(call, CURLOPT_TIMEOUT, static_cast<long>(options_.timeout.count()));
  curl_easy_setopt(call, CURLOPT_WRITEFUNCTION, ignore);
  const CURLcode done = curl_easy_perform(call);
  if (done != CURLE_OK) {
    why = curl_easy_strerror(done);
    return Answer::again;
  }
  long status = 0;
  curl_easy_getinfo(call, CURLINFO_RESPONSE_CODE, &status);
  if (status >= 200 && status < 300) return Answer::taken;
  why = fmt::format("the other side answers {}", status);
  return status == kTooManyRequests || status >= 500 ? Answer::again : Answer::refused;
}

}  // namespace hyades::coordinator
