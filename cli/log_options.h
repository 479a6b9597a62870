#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "farm/log.h"

namespace hyades::cli {

/// --log-level and --log-format, as coordinator and worker have them.
inline void add_log_options(CLI::App& app, farm::LogOptions& log) {
  app.add_option_function<std::string>(
         "--log-level",
         [&log](const std::string& name) {
           const auto level = farm::read_log_level(name);
           if (!level) throw CLI::ValidationError("--log-level", level.error().message);
           log.level = *level;
         },
         "what standard error is told: what is as weighty as that, or weightier (default: info)")
      ->type_name("debug|info|warning|error");
  app.add_option_function<std::string>(
         "--log-format",
         [&log](const std::string& name) {
           const auto format = farm::read_log_format(name);
           if (!format) throw CLI::ValidationError("--log-format", format.error().message);
           log.format = *format;
         },
         "how: as text, or as JSON with time, level and the ids of job, frame, unit and worker as "
         "fields (default: text)")
      ->type_name("text|json");
}

}  // namespace hyades::cli
