#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

/// Something about a job that somebody wants to hear of.
struct News {
  enum class Kind { done, failed, stalled };
  Kind kind = Kind::done;
  v1::Job job;
  std::vector<std::string> reasons{};  ///< of a job that stands still: why, as `explain` has it
};

/// The kind in one word, for programs: "done", "failed", "stalled".
const char* name_of(News::Kind kind);

/// Makes a text that somebody else has written (a job's name, a reason) harmless in a message.
using QuoteText = std::string (*)(std::string_view text);

/// One line for people: "Job 7, balls, is done: 120 frames in 1 h 12 min". Names and reasons go
/// through `quote`.
std::string text_of(const News& news, QuoteText quote);

/// `text` as code of chat servers, which call nobody and link nowhere from there: between
/// backticks, without any in it, and with &, < and > as Slack wants them.
std::string as_code(std::string_view text);

/// For programs: event, text, job (as the HTTP API shows it), reasons, and where the dashboard
/// shows it (`dashboard`: its URL, or empty). JSON.
std::string program_message(const News& news, const std::string& dashboard);

/// For chat servers (Slack, Mattermost, Rocket.Chat, Google Chat and others): {"text": ...}. JSON.
std::string chat_message(const News& news, const std::string& dashboard);

}  // namespace hyades::coordinator
