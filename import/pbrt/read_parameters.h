#pragma once

#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "import/pbrt/parameters.h"
#include "import/pbrt/tokenizer.h"

namespace hyades::core::pbrt {

/// A finite number; nothing where the word is none.
std::optional<double> number_of(std::string_view word);

/// Reads all parameters up to the next directive. The last of several of one name comes first.
Result<Parameters> read_parameters(Tokenizer& tokens, const RgbSpace* space, bool inherited);

}  // namespace hyades::core::pbrt
