#include "cli/command_line.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "cli/help_formatter.h"
#include "core/base/printable.h"
#include "core/base/text.h"

namespace hyades::cli {
namespace {

void format_help(CLI::App& app) {
  static const auto formatter = std::make_shared<HelpFormatter>();
  app.formatter(formatter);
  for (CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; })) format_help(*sub);
  if (CLI::Option* help = app.get_help_ptr()) help->description("print this help");
}

/// A subcommand's --help ends with those lines of its command's that are about it: the examples
/// that call it, and the exit statuses.
void share_footer(CLI::App& app) {
  for (CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; })) {
    if (!sub->get_footer().empty()) continue;
    const std::string call = "  " + app.get_name() + " " + sub->get_name() + " ";
    std::string examples;
    std::string statuses;
    std::istringstream lines(app.get_footer());
    for (std::string line; std::getline(lines, line);) {
      if ((line + " ").starts_with(call)) examples += line + "\n";
      if (line.starts_with("exit status")) statuses = line;
    }
    if (!examples.empty()) sub->footer("examples:\n" + examples + statuses);
  }
}

}  // namespace

std::string in_our_words(const CLI::App& app, const CLI::ParseError& error) {
  std::string text = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    const std::vector<std::string> extras = app.remaining(true);
    const std::string extra = extras.empty() ? std::string() : extras.front();
    if (!extra.starts_with('-')) return "'" + extra + "' is one argument too many";
    std::vector<std::string> options;
    std::vector<const CLI::App*> called{&app};
    for (const CLI::App* command : app.get_subcommands()) called.push_back(command);
    for (const CLI::App* command : called) {
      for (const CLI::Option* option : command->get_options()) {
        for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
      }
    }
    const std::string name = extra.substr(0, extra.find('='));
    // What begins one, by two letters at least, is nearer to it than what is spelled alike: --prio
    // is --priority.
    std::vector<std::string> longer;
    std::copy_if(options.begin(), options.end(), std::back_inserter(longer),
                 [&](const std::string& one) { return name.size() > 3 && one.starts_with(name); });
    const std::string hint = longer.size() == 1 ? ", did you mean '" + longer.front() + "'?"
                                                : core::did_you_mean(name, options);
    return "there is no option '" + name + "'" + hint;
  }
  std::smatch parts;
  static const std::regex conversion("Could not convert: (\\S+) = (.*)");
  if (std::regex_match(text, parts, conversion)) {
    return parts[1].str() + " " + parts[2].str() + ": expected a number";
  }
  static const std::regex no_command("A subcommand is required");
  if (std::regex_match(text, no_command)) {
    text = "expected one of";
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
      text += (text.ends_with("of") ? " " : ", ") + command->get_name();
    }
    return text;
  }
  static const std::regex missing("(\\S+) is required");
  if (std::regex_match(text, parts, missing)) {
    const CLI::Option* option = app.get_option_no_throw(parts[1].str());
    const std::string what = option != nullptr ? option->get_description() : "";
    return parts[1].str() + " is missing" + (what.empty() ? "" : ": expected " + what);
  }
  static const std::regex no_value("(\\S+): 1 required .* missing");
  if (std::regex_match(text, parts, no_value)) return parts[1].str() + ": expected a value";
  static const std::regex size("(\\S+): .* unit not recognized.*");
  if (std::regex_match(text, parts, size)) return parts[1].str() + ": expected a size such as 8G";
  static const std::regex member("(\\S+): (.*) not in \\{(.*)\\}");
  if (std::regex_match(text, parts, member)) {
    static const std::regex comma(",");
    return parts[1].str() + " " + parts[2].str() + ": expected " +
           std::regex_replace(parts[3].str(), comma, " or ");
  }
  static const std::regex excludes("(\\S+) excludes (\\S+)");
  if (std::regex_match(text, parts, excludes)) {
    return parts[1].str() + ": expected no " + parts[2].str() + " beside it";
  }
  static const std::regex ours("(--\\S+): (.+): (expected .*)");
  if (std::regex_match(text, parts, ours)) {
    return parts[1].str() + " " + parts[2].str() + ": " + parts[3].str();
  }
  return text;
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv, int wrong) {
  share_footer(app);
  format_help(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s: %s (%s --help tells more)\n", app.get_name().c_str(),
                 core::printable(in_our_words(app, error)).c_str(), app.get_name().c_str());
    return wrong;
  }
  return std::nullopt;
}

void print_error(const core::Error& error, const std::string& path) {
  std::string text = error.message;
  const std::string shown = core::printable(path);
  if (shown != path) {
    for (size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += shown.size()) {
      text.replace(at, path.size(), shown);
    }
  }
  while (text.ends_with('\n')) text.pop_back();  // complaints are lines
  std::fprintf(stderr, "%s\n", core::printable_lines(text).c_str());
}

}  // namespace hyades::cli
