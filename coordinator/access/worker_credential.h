#pragma once

#include <string>

namespace hyades::coordinator {

/// By what a worker is known: whose word it is that a film is right, or that a unit cannot be
/// rendered.
struct WorkerCredential {
  /// The same for workers whose words count as one. Empty: nobody else has it, as on farms where
  /// whoever may work may do everything.
  std::string name{};
  std::string machine_token{};  ///< to be kept by the worker and shown from now on; empty: none
};

}  // namespace hyades::coordinator
