#pragma once

#include <ctime>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace hyades::worker {

/// A cloud has said that it takes this machine away.
struct Notice {
  std::string at;         ///< when, UTC: "2026-03-01T12:00:00Z"
  double seconds_left{};  ///< until then; 0 to 3600
};

/// What a cloud gives where it does not say when, in seconds: the least of the three.
constexpr double kShortestNotice = 30;

/// A notice of a time, Unix seconds; `now` likewise.
Notice notice_at(std::time_t at, std::time_t now);

/// The body of AWS' /latest/meta-data/spot/instance-action.
core::Result<Notice> parse_aws(const std::string& body, std::time_t now);

/// The body of Azure's /metadata/scheduledevents: a notice where one of the events takes the
/// machine called `machine` away. Other events (a reboot, maintenance in place) are none.
core::Result<std::optional<Notice>> parse_azure(const std::string& body, const std::string& machine,
                                                std::time_t now);

/// The body of Google's instance/preempted.
core::Result<bool> parse_gcp_preempted(const std::string& body);

}  // namespace hyades::worker
