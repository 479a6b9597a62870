#pragma once

#include <span>
#include <string>
#include <string_view>

namespace hyades::core {

/// What `word`, of other renderers mostly, is called here where one of `names` was expected: "cube"
/// is a "box"; or a name that ends or begins with it: "color" may be "base_color". ", did you mean
/// 'box'?", or "; ..." and what to do instead; "" where it is not known.
std::string other_word(std::string_view word, std::span<const std::string> names);

/// other_word(), or else a name that is spelled nearly so.
std::string suggest(std::string_view word, std::span<const std::string> names);

}  // namespace hyades::core
