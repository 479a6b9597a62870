#include "coordinator/notify/news.h"

#include <fmt/format.h>
#include <cstdint>

#include "core/base/printable.h"
#include "core/base/text.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

std::string address_of(const News& news, const std::string& dashboard) {
  return dashboard.empty() ? "" : fmt::format("{}/#/jobs/{}", dashboard, news.job.id());
}

std::string dump(const farm::Json& json) {
  return json.dump(-1, ' ', false, farm::Json::error_handler_t::replace);
}

}  // namespace

const char* name_of(News::Kind kind) {
  switch (kind) {
    case News::Kind::done:
      return "done";
    case News::Kind::failed:
      return "failed";
    case News::Kind::stalled:
      break;
  }
  return "stalled";
}

std::string text_of(const News& news, QuoteText quote) {
  const v1::Job& job = news.job;
  const std::string who = fmt::format("Job {}, {}, ", job.id(), quote(job.name()));
  const auto because = [&](const std::string& reason) {
    return reason.empty() ? std::string() : ": " + quote(reason);
  };
  const int64_t begun = job.begun_ms() != 0 ? job.begun_ms() : job.submitted_ms();
  switch (news.kind) {
    case News::Kind::done:
      return who +
             fmt::format("is done: {} in {}", core::counted(job.frames_done(), "frame"),
                         core::format_duration(1e-3 * static_cast<double>(job.ended_ms() - begun)));
    case News::Kind::failed:
      return who + fmt::format("failed: {} of {} are done{}", job.frames_done(),
                               core::counted(job.frames(), "frame"), because(job.reason()));
    case News::Kind::stalled:
      break;
  }
  return who + "stands still" + because(news.reasons.empty() ? "" : news.reasons.front());
}

std::string as_code(std::string_view text) {
  std::string code = "`";
  for (const char c : core::printable(text)) {
    switch (c) {
      case '&':
        code += "&amp;";
        break;
      case '<':
        code += "&lt;";
        break;
      case '>':
        code += "&gt;";
        break;
      case '`':
        code += '\'';
        break;
      default:
        code += c;
    }
  }
  return code + "`";
}

std::string program_message(const News& news, const std::string& dashboard) {
  farm::Json json = {{"event", name_of(news.kind)},
                     {"text", text_of(news, core::printable)},
                     {"job", farm::to_json(news.job)},
                     {"reasons", news.reasons}};
  if (!dashboard.empty()) json["url"] = address_of(news, dashboard);
  return dump(json);
}

std::string chat_message(const News& news, const std::string& dashboard) {
  const std::string address = address_of(news, dashboard);
  return dump({{"text", text_of(news, as_code) + (address.empty() ? "" : "\n" + address)}});
}

}  // namespace hyades::coordinator
