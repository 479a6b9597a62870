#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "import/pbrt/place.h"

namespace hyades::core::pbrt {

/// A piece of a scene file.
struct Token {
  enum class Kind : uint8_t {
    end,
    word,    ///< a directive, a number, true or false
    text,    ///< what stands in quotes, without them, escapes undone
    open,    ///< [
    close,   ///< ]
    broken,  ///< not in the language: `text` says why
  };
  Kind kind = Kind::end;
  std::string_view text;
  int line = 0;
  int column = 0;
};

/// Cuts a scene file's text into tokens; comments begin with '#' and end with the line. The text
/// must outlive it and the tokens.
class Tokenizer {
 public:
  Tokenizer(std::string_view text, std::string file);

  const Token& peek();
  Token next();
  Place place(const Token& token) const;

 private:
  Token read();
  Token read_text();
  Token broken(Token token, std::string why);
  void skip_blanks();

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  size_t at_ = 0;
  int line_ = 1;
  size_t line_start_ = 0;
  Token ahead_;
  bool has_ahead_ = false;
  std::deque<std::string> kept_;  ///< texts that are not as they stand in the file
};

}  // namespace hyades::core::pbrt
