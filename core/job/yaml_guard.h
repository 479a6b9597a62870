#pragma once

#include <string>
#include <string_view>

#include "core/job/source.h"

namespace hyades::core {

/// What is checked before a YAML library sees a text, because the library would spend unbounded
/// memory on it or read it in surprising ways: size, UTF-8, control characters, the number of
/// brackets left open. False (with a complaint) where the text is refused.
bool check_yaml_text(std::string_view text, const std::string& file, Diagnostics& diagnostics);

/// A hint for a syntax error that a tab or an unquoted `#d8c8a8` may have caused (a YAML comment
/// swallows the rest of its line, closing brackets included), else "".
std::string hint_for_syntax_error(std::string_view text);

}  // namespace hyades::core
