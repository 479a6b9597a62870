#include "core/job/yaml_guard.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "core/base/text.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

namespace {

/// yaml-cpp keeps every open bracket's tokens in memory until it is closed; comments and texts may
/// hold a few unmatched ones ("[0, 1)"), so the limit is generous.
constexpr int64_t kMaxOpenBrackets = 10'000;

bool is_hex(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

}  // namespace

bool check_yaml_text(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  if (text.size() > kMaxYamlBytes) {
    diagnostics.add({file, 0, 0}, "the file has " + std::to_string(text.size()) +
                                      " bytes; a job may have at most " +
                                      std::to_string(kMaxYamlBytes));
    return false;
  }
  int line = 1;
  int column = 1;
  int64_t open_brackets = 0;
  for (size_t i = 0; i < text.size();) {
    const size_t length = utf8_length(text.substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      diagnostics.add({file, line, column}, "not UTF-8 text; a job is a UTF-8 YAML file");
      return false;
    }
    if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F) {
      diagnostics.add({file, line, column}, "the control character " + std::to_string(byte) +
                                                "; a job is a UTF-8 YAML file");
      return false;
    }
    if (byte == '[' || byte == '{') ++open_brackets;
    if ((byte == ']' || byte == '}') && open_brackets > 0) --open_brackets;
    if (open_brackets > kMaxOpenBrackets) {
      diagnostics.add({file, line, column},
                      "more than " + std::to_string(kMaxOpenBrackets) + " brackets left open");
      return false;
    }
    i += length;
    ++column;
    if (byte == '\n') {
      ++line;
      column = 1;
    }
  }
  return true;
}

std::string hint_for_syntax_error(std::string_view text) {
  int line = 1;
  bool indenting = true;
  char previous = '\n';  // last character that is not a space
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\t' && indenting) {
      return fmt::format(" (line {} is indented with a tab; YAML wants spaces)", line);
    }
    if (c == '#' && (previous == ':' || previous == ',' || previous == '[')) {
      size_t digits = 0;
      while (i + 1 + digits < text.size() && is_hex(text[i + 1 + digits])) ++digits;
      if (digits == 3 || digits == 6) {
        return fmt::format(
            " (line {0} has an unquoted {1}: # starts a comment there; write "
            "\"{1}\")",
            line, text.substr(i, digits + 1));
      }
    }
    if (c != ' ' && c != '\t') {
      previous = c;
      indenting = c == '\n';
    }
    if (c == '\n') ++line;
  }
  return "";
}

}  // namespace hyades::core
