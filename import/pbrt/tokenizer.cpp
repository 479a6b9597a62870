#include "import/pbrt/tokenizer.h"

#include <array>
#include <cstddef>
#include <utility>

namespace hyades::core::pbrt {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

enum class Role : uint8_t { within, ends, control };

/// What each byte is to a word.
constexpr std::array<Role, 256> kRoles = [] {
  std::array<Role, 256> roles{};
  for (size_t c = 0; c < 0x20; ++c) roles[c] = Role::control;
  roles[0x7F] = Role::control;
  for (const char c : {' ', '\t', '\n', '\r', '"', '[', ']', '#'}) {
    roles[static_cast<unsigned char>(c)] = Role::ends;
  }
  return roles;
}();

Role role_of(char c) { return kRoles[static_cast<unsigned char>(c)]; }

}  // namespace

Tokenizer::Tokenizer(std::string_view text, std::string file)
    : text_(text), file_(std::make_shared<const std::string>(std::move(file))) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = line_start_ = 3;  // the mark of UTF-8
}

const Token& Tokenizer::peek() {
  if (!std::exchange(has_ahead_, true)) ahead_ = read();
  return ahead_;
}

Token Tokenizer::next() {
  if (std::exchange(has_ahead_, false)) return ahead_;
  return read();
}

Place Tokenizer::place(const Token& token) const { return {file_, token.line, token.column}; }

void Tokenizer::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if (c == '#') {
      while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
    } else if (!is_blank(c)) {
      return;
    }
  }
}

Token Tokenizer::broken(Token token, std::string why) {
  token.kind = Token::Kind::broken;
  token.text = kept_.emplace_back(std::move(why));
  at_ = text_.size();
  return token;
}

Token Tokenizer::read() {
  skip_blanks();
  Token token;
  token.line = line_;
  token.column = static_cast<int>(at_ - line_start_) + 1;
  if (at_ >= text_.size()) return token;
  const char c = text_[at_];
  if (c == '"') {
    token = read_text();
  } else if (c == '[' || c == ']') {
    token.kind = c == '[' ? Token::Kind::open : Token::Kind::close;
    token.text = text_.substr(at_++, 1);
  } else {
    const size_t start = at_;
    while (at_ < text_.size() && role_of(text_[at_]) == Role::within) ++at_;
    if (at_ < text_.size() && role_of(text_[at_]) == Role::control) {
      return broken(token, "found a control character, expected text");
    }
    token.kind = Token::Kind::word;
    token.text = text_.substr(start, at_ - start);
  }
  return token;
}

Token Tokenizer::read_text() {
  Token token;
  token.kind = Token::Kind::text;
  token.line = line_;
  token.column = static_cast<int>(at_ - line_start_) + 1;
  const size_t start = ++at_;
  std::string undone;
  bool escaped = false;
  for (; at_ < text_.size(); ++at_) {
    char c = text_[at_];
    if (c == '"') {
      token.text =
          escaped ? kept_.emplace_back(std::move(undone)) : text_.substr(start, at_ - start);
      ++at_;
      return token;
    }
    if (c == '\n') break;
    if (c == '\\') {
      if (!std::exchange(escaped, true)) undone = text_.substr(start, at_ - start);
      if (++at_ >= text_.size()) break;
      c = text_[at_];
      constexpr std::string_view kLetters = "bfnrt\\'\"";
      constexpr std::string_view kMeant = "\b\f\n\r\t\\'\"";
      const size_t which = kLetters.find(c);
      if (which == std::string_view::npos) {
        return broken(token, std::string("found the escape \\") + c +
                                 ", expected \\b, \\f, \\n, \\r, \\t, \\\\, \\' or \\\"");
      }
      c = kMeant[which];
    }
    if (escaped) undone += c;
  }
  return broken(token, "found the end of the line within quotes, expected \"");
}

}  // namespace hyades::core::pbrt
