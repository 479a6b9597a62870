#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hyades::cli {

/// How --help tells options: their names and what they take in one column, what they do in another;
/// all is wrapped to the terminal's width (100 columns where there is none).
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace hyades::cli
