#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/result.h"

namespace hyades::cli {

/// Has a shell run `command` with the number of workers as a further argument and in the
/// environment as HYADES_WANTED. After `limit` seconds it is ended, with all that it has started.
/// The error says what the command said last. `stop`: asked often; ends the wait.
core::Status call_scaler(const std::string& command, uint32_t wanted, double limit,
                         const std::function<bool()>& stop);

}  // namespace hyades::cli
