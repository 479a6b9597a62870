#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "core/base/duration.h"

namespace hyades::cli {

/// An option that takes a length of time (core/base/duration.h), at least `least` seconds, into
/// `seconds`.
inline CLI::Option* add_duration(CLI::App& app, const std::string& name, double& seconds,
                                 const std::string& help, double least = 0) {
  return app
      .add_option_function<std::string>(
          name,
          [&seconds](const std::string& text) { seconds = core::parse_duration(text).value(); },
          help)
      ->type_name("TIME")
      ->check([least](const std::string& text) -> std::string {
        const auto parsed = core::parse_duration(text);
        if (!parsed) return parsed.error().message;
        if (*parsed >= least) return {};
        return text + ": expected at least " + CLI::detail::to_string(least) + " s";
      });
}

}  // namespace hyades::cli
