#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/job/animated.h"

namespace hyades::core {

/// Compiles the text behind the '=' of an expression ("0.5 * t"). Operators by rising precedence:
/// c ? a : b, ||, &&, == != < > <= >=, + -, * /, ^ (power); names as listed at Expression. Errors
/// say what is wrong and, for an unknown name, which are known. At most 1,000 characters.
Result<std::shared_ptr<const Expression>> compile_expression(const std::string& text);

}  // namespace hyades::core
