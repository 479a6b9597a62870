#include "cli/json_report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace hyades::cli {
namespace {

using nlohmann::ordered_json;

constexpr auto kEvery = std::chrono::milliseconds(200);

/// At once, for who reads it waits. Names that are no UTF-8 are told as far as they are.
void print_line(const ordered_json& json) {
  const auto replace = ordered_json::error_handler_t::replace;
  std::printf("%s\n", json.dump(-1, ' ', false, replace).c_str());
  std::fflush(stdout);
}

}  // namespace

void JsonReport::progress(const coordinator::Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (!asked_ || now - last_ < kEvery) return;
  last_ = now;
  ordered_json json = {{"event", "progress"},
                       {"samples", progress.samples},
                       {"samples_done", progress.samples_done},
                       {"frames", progress.frames},
                       {"frames_done", progress.frames_done},
                       {"frames_failed", progress.frames_failed},
                       {"samples_per_second", progress.samples_per_second},
                       {"seconds_left", progress.seconds_left}};
  if (progress.noise >= 0.0) json["noise"] = progress.noise;
  print_line(json);
}

void JsonReport::written(std::optional<int32_t> frame,
                         const std::vector<std::string>& files) const {
  if (!asked_) return;
  ordered_json json = {{"event", "written"}};
  if (frame) json["frame"] = *frame;
  json["files"] = files;
  print_line(json);
}

}  // namespace hyades::cli
