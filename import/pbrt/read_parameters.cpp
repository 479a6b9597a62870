#include "import/pbrt/read_parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace hyades::core::pbrt {
namespace {

const std::vector<std::string>& type_names() {
  static const std::vector<std::string> names = {
      "bool",   "integer", "float",   "point2", "vector2",  "point3",   "vector3",
      "normal", "string",  "texture", "rgb",    "spectrum", "blackbody"};
  return names;
}

/// What older files call them.
std::string modern_type(std::string_view type) {
  if (type == "point") return "point3";
  if (type == "vector") return "vector3";
  if (type == "normal3") return "normal";
  if (type == "color") return "rgb";
  return std::string(type);
}

bool holds_texts(const std::string& type) { return type == "string" || type == "texture"; }

/// Reads one parameter's values.
class ValueReader {
 public:
  ValueReader(Tokenizer& tokens, Parameter& parameter) : tokens_(tokens), p_(parameter) {}

  Status read() {
    const Token first = tokens_.next();
    if (first.kind != Token::Kind::open) return add(first);
    for (;;) {
      const Token token = tokens_.next();
      if (token.kind == Token::Kind::close) break;
      if (Status s = add(token); !s) return s;
    }
    if (p_.numbers.empty() && p_.integers.empty() && p_.flags.empty() && p_.texts.empty()) {
      return p_.place.error("parameter '" + p_.name + "' has no values");
    }
    return {};
  }

 private:
  Error unexpected(const Token& token) const {
    const Place place = tokens_.place(token);
    if (token.kind == Token::Kind::broken) return place.error(std::string(token.text));
    std::string expected = "a number";
    if (holds_texts(p_.type)) expected = "a text in quotes";
    if (p_.type == "bool") expected = "true or false";
    if (p_.type == "integer") expected = "a whole number of 32 bits";
    const std::string found = token.kind == Token::Kind::end ? "the end of the file"
                                                             : "'" + std::string(token.text) + "'";
    return place.error("parameter '" + p_.name + "' has " + found + ", expected " + expected);
  }

  Status add(const Token& token) {
    if (token.kind == Token::Kind::text) {
      if (p_.type == "bool" && (token.text == "true" || token.text == "false")) {
        p_.flags.push_back(token.text == "true" ? 1 : 0);  // files of pbrt-v3
        return {};
      }
      if (!holds_texts(p_.type) && p_.type != "spectrum") return unexpected(token);
      if (p_.type == "spectrum" && !p_.numbers.empty()) return unexpected(token);
      p_.texts.emplace_back(token.text);
      return {};
    }
    if (token.kind != Token::Kind::word || holds_texts(p_.type)) return unexpected(token);
    if (p_.type == "bool") {
      if (token.text != "true" && token.text != "false") return unexpected(token);
      p_.flags.push_back(token.text == "true" ? 1 : 0);
      return {};
    }
    if (p_.type == "integer") {
      const std::string_view digits = token.text.substr(token.text.front() == '+' ? 1 : 0);
      int32_t value = 0;
      const auto [end, wrong] =
          std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (wrong != std::errc() || end != digits.data() + digits.size()) return unexpected(token);
      p_.integers.push_back(value);
      return {};
    }
    const auto value = number_of(token.text);
    const float narrow = value ? static_cast<float>(*value) : 0.0F;
    if (!value || !std::isfinite(narrow) || !p_.texts.empty()) return unexpected(token);
    p_.numbers.push_back(narrow);
    return {};
  }

  Tokenizer& tokens_;
  Parameter& p_;
};

Result<ParameterPtr> read_one(Tokenizer& tokens, const RgbSpace* space, bool inherited) {
  const Token declaration = tokens.next();
  auto p = std::make_shared<Parameter>();
  p->place = tokens.place(declaration);
  p->space = space;
  p->inherited = inherited;
  constexpr std::string_view kBlanks = " \t";
  std::string_view text = declaration.text;
  std::array<std::string_view, 2> words;
  for (std::string_view& word : words) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
  }
  if (words[1].empty()) {
    return p->place.error("found \"" + std::string(declaration.text) +
                          "\", expected a type and a name such as \"float radius\"");
  }
  p->type = modern_type(words[0]);
  p->name = words[1];
  if (std::find(type_names().begin(), type_names().end(), p->type) == type_names().end()) {
    return p->place.error("'" + p->type + "' is no type of parameters" +
                          did_you_mean(p->type, type_names()) + " (" + join_names(type_names()) +
                          ")");
  }
  if (Status s = ValueReader(tokens, *p).read(); !s) return s.error();
  return ParameterPtr(std::move(p));
}

}  // namespace

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (wrong == std::errc::result_out_of_range) {
    // Too small is 0 for our purposes; too large is no number.
    const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return small ? std::optional<double>(0.0) : std::nullopt;
  }
  if (wrong != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<Parameters> read_parameters(Tokenizer& tokens, const RgbSpace* space, bool inherited) {
  Parameters out;
  while (tokens.peek().kind == Token::Kind::text) {
    auto p = read_one(tokens, space, inherited);
    if (!p) return p.error();
    out.push_back(std::move(*p));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace hyades::core::pbrt
