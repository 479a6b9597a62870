#include "worker/clouds/notice.h"

#include <strings.h>

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace hyades::worker {
namespace {

constexpr double kLongestNotice = 3600;

/// A UTC time in a format of strptime; nothing where it is none.
std::optional<std::time_t> read_time(const std::string& text, const char* format) {
  std::tm parts{};
  const char* end = ::strptime(text.c_str(), format, &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return ::timegm(&parts);
}

/// A field that is text; empty where it is not there or something else.
std::string text_of(const nlohmann::json& object, const char* field) {
  const auto found = object.find(field);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool same_name(const std::string& a, const std::string& b) {
  return ::strcasecmp(a.c_str(), b.c_str()) == 0;  // Azure's names have no case
}

}  // namespace

Notice notice_at(std::time_t at, std::time_t now) {
  std::tm parts{};
  ::gmtime_r(&at, &parts);
  std::array<char, 64> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text.data(), std::clamp(std::difftime(at, now), 0.0, kLongestNotice)};
}

core::Result<Notice> parse_aws(const std::string& body, std::time_t now) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  const std::string action = json.is_object() ? text_of(json, "action") : std::string();
  if (action.empty()) return core::Error{"what came is no instance action"};
  // Whatever happens to it, terminate, stop or hibernate: it is gone for now.
  const auto at = read_time(text_of(json, "time"), "%Y-%m-%dT%H:%M:%SZ");
  return notice_at(at.value_or(now + static_cast<std::time_t>(kShortestNotice)), now);
}

core::Result<std::optional<Notice>> parse_azure(const std::string& body, const std::string& machine,
                                                std::time_t now) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  const auto events = json.is_object() ? json.find("Events") : json.end();
  if (!json.is_object() || events == json.end() || !events->is_array()) {
    return core::Error{"what came is no list of scheduled events"};
  }
  for (const nlohmann::json& event : *events) {
    if (!event.is_object()) return core::Error{"what came is no list of scheduled events"};
    const std::string type = text_of(event, "EventType");
    if (type != "Preempt" && type != "Terminate") continue;
    const auto machines = event.find("Resources");
    if (machines == event.end() || !machines->is_array()) continue;
    const bool ours = std::any_of(machines->begin(), machines->end(), [&](const auto& name) {
      return name.is_string() && same_name(name.template get<std::string>(), machine);
    });
    if (!ours) continue;
    // No time where it has begun.
    const auto at = read_time(text_of(event, "NotBefore"), "%a, %d %b %Y %H:%M:%S GMT");
    return std::optional(
        notice_at(at.value_or(now + static_cast<std::time_t>(kShortestNotice)), now));
  }
  return std::optional<Notice>();
}

core::Result<bool> parse_gcp_preempted(const std::string& body) {
  const std::string word = body.substr(0, body.find_last_not_of(" \r\n") + 1);
  if (word == "TRUE" || word == "FALSE") return word == "TRUE";
  return core::Error{"what came is neither TRUE nor FALSE"};
}

}  // namespace hyades::worker
