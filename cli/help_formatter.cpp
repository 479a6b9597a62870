#include "cli/help_formatter.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <sstream>
#include <utility>

namespace hyades::cli {
namespace {

constexpr size_t kNames = 26;  ///< columns of names and what follows them

size_t columns() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? std::clamp<size_t>(size.ws_col, 60, 120) : 100;
}

/// "FILE" of "token-file".
std::string last_word(const std::string& name) {
  std::string word = name.substr(name.rfind('-') + 1);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return word;
}

/// What an option takes: "N", "DIR"; empty of flags.
std::string value_of(const CLI::Option* option) {
  const std::string name = option->get_type_name();
  if (name.find("SIZE") != std::string::npos) return "SIZE";
  if (const size_t open = name.find(":{"); open != std::string::npos && name.back() == '}') {
    std::string members = name.substr(open + 2, name.size() - open - 3);
    std::replace(members.begin(), members.end(), ',', '|');
    return members;
  }
  const std::string type = name.substr(0, name.find(':'));  // checks of values stand behind it
  if (type == "INT" || type == "UINT" || type == "FLOAT") return "N";
  return type == "TEXT" ? last_word(option->get_lnames().front()) : type;
}

std::string names_of(const CLI::Option* option, bool is_positional) {
  if (is_positional) return option->get_name(true, false);
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const std::string& name : option->get_snames()) add("-" + name);
  for (const std::string& name : option->get_lnames()) add("--" + name);
  const std::string value = value_of(option);
  const bool joined = value.starts_with("[=");
  return value.empty() ? names : names + (joined ? "" : " ") + value;
}

std::string described(const CLI::Option* option, bool is_positional) {
  std::string text = option->get_description();
  const std::string standard = option->get_default_str();
  if (!standard.empty() && text.find("(default") == std::string::npos) {
    text += " (default: " + standard + ")";
  }
  if (option->get_required() && !is_positional) text += " (required)";
  std::string others;
  for (const CLI::Option* other : option->get_excludes()) {
    others += (others.empty() ? " (not beside " : ", ") + other->get_name();
  }
  return others.empty() ? text : text + others + ")";
}

/// Appends `text` to a line that has `column` columns, of which `indent` are empty on each line.
void append_words(std::string& all, const std::string& text, size_t column, size_t indent) {
  std::istringstream words(text);
  const size_t width = columns();
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > width) {
      all += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      all += ' ';
      ++column;
    }
    all += word;
    column += word.size();
  }
  all += '\n';
}

/// Each line of `text` in as many as it needs; those that are indented are to be copied and stay.
std::string wrapped(const std::string& text) {
  std::string all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(' ')) {
      all += line + "\n";
    } else {
      append_words(all, line, 0, 0);
    }
  }
  return all;
}

/// `text` in the column beside `names`.
std::string beside(const std::string& names, const std::string& text) {
  std::string all = "  " + names;
  if (all.size() + 2 > kNames) {
    all += "\n" + std::string(kNames, ' ');
  } else {
    all.append(kNames - all.size(), ' ');
  }
  append_words(all, text, kNames, kNames);
  return all;
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return beside(names_of(option, is_positional), described(option, is_positional));
}

/// With one empty line between two groups: the base has one before each and one behind it.
std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  const std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
  return CLI::detail::find_and_replace(text, "\n\n\n", "\n\n");
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return wrapped(CLI::Formatter::make_description(app));
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
  return wrapped(CLI::Formatter::make_footer(app));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return beside(command->get_name(), command->get_description());
}

}  // namespace hyades::cli
