#include "worker/clouds/metadata.h"

#include <strings.h>

#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include <curl/curl.h>

namespace hyades::worker {
namespace {

constexpr size_t kLongestBody = size_t{64} << 10U;
constexpr int kGlance = 100;  ///< milliseconds between looks whether to stop

/// libcurl's own state, made once before any thread needs it.
void prepare_library() {
  static const auto ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  (void)ready;
}

size_t take_body(char* bytes, size_t size, size_t count, void* to) {
  std::string& body = *static_cast<std::string*>(to);
  if (body.size() + size * count > kLongestBody) return 0;
  body.append(bytes, size * count);
  return size * count;
}

size_t take_header(char* bytes, size_t size, size_t count, void* to) {
  constexpr std::string_view kEtag = "etag:";
  const std::string_view line(bytes, size * count);
  if (line.size() <= kEtag.size() || line.size() > 200 ||
      ::strncasecmp(line.data(), kEtag.data(), kEtag.size()) != 0) {
    return size * count;
  }
  std::string& etag = *static_cast<std::string*>(to);
  etag.clear();
  // What may stand in a URL as it is: whatever else comes is none of Google's.
  for (const char c : line.substr(kEtag.size())) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain || c == '-' || c == '_') etag += c;
  }
  return size * count;
}

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* what) const {
    (void)Free(what);
  }
};

}  // namespace

core::Result<Metadata::Answer> Metadata::ask(const std::string& path,
                                             const std::vector<std::string>& headers,
                                             std::chrono::seconds patience, bool put) const {
  prepare_library();
  const core::Error no_memory{"no memory"};
  const std::unique_ptr<CURLM, Freed<curl_multi_cleanup>> calls(curl_multi_init());
  const std::unique_ptr<CURL, Freed<curl_easy_cleanup>> owned(curl_easy_init());
  if (!calls || !owned) return no_memory;
  std::unique_ptr<curl_slist, Freed<curl_slist_free_all>> lines;
  for (const std::string& header : headers) {
    curl_slist* longer = curl_slist_append(lines.get(), header.c_str());
    if (longer == nullptr) return no_memory;
    (void)lines.release();
    lines.reset(longer);
  }
  Answer answer;
  CURL* call = owned.get();
  const std::string url = endpoint_ + path;
  curl_easy_setopt(call, CURLOPT_URL, url.c_str());
  curl_easy_setopt(call, CURLOPT_PROTOCOLS_STR, "http");
  curl_easy_setopt(call, CURLOPT_PROXY, "");
  curl_easy_setopt(call, CURLOPT_HTTPHEADER, lines.get());
  if (put) {
    curl_easy_setopt(call, CURLOPT_CUSTOMREQUEST, "PUT");
    curl_easy_setopt(call, CURLOPT_POSTFIELDS, "");
  }
  curl_easy_setopt(call, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(call, CURLOPT_CONNECTTIMEOUT, 5L);
  curl_easy_setopt(call, CURLOPT_TIMEOUT, static_cast<long>(patience.count()));
  curl_easy_setopt(call, CURLOPT_WRITEFUNCTION, take_body);
  curl_easy_setopt(call, CURLOPT_WRITEDATA, &answer.body);
  curl_easy_setopt(call, CURLOPT_HEADERFUNCTION, take_header);
  curl_easy_setopt(call, CURLOPT_HEADERDATA, &answer.etag);
  curl_multi_add_handle(calls.get(), call);
  int running = 1;
  while (running > 0 && !stopped_) {
    if (curl_multi_perform(calls.get(), &running) != CURLM_OK) break;
    if (running > 0) curl_multi_poll(calls.get(), nullptr, 0, kGlance, nullptr);
  }
  core::Result<Answer> result = core::Error{"no answer"};
  int left = 0;
  if (const CURLMsg* message = curl_multi_info_read(calls.get(), &left);
      message != nullptr && message->msg == CURLMSG_DONE) {
    if (message->data.result == CURLE_OK) {
      curl_easy_getinfo(call, CURLINFO_RESPONSE_CODE, &answer.status);
      result = std::move(answer);
    } else {
      result = core::Error{curl_easy_strerror(message->data.result)};
    }
  }
  curl_multi_remove_handle(calls.get(), call);
  return result;
}

}  // namespace hyades::worker
