#pragma once

#include <cstdint>
#include <string>

namespace hyades::coordinator {

/// By what a worker is known: whose word it is that a film is right, or that a unit cannot be
/// rendered.
struct WorkerCredential {
  /// Equal for workers whose words count as one. Empty: nobody else has it, as on farms where
  /// whoever may work may do everything.
  std::string name{};
  /// Names the token or pool that the worker came by, which can bring any number of workers, also
  /// such as have names of their own. Empty: as `name` says.
  std::string origin{};
  std::string machine_token{};  ///< to be kept by the worker and shown from now on; empty: none
  /// Whose the worker is: nobody else may come under its id. Empty: anybody's, as the farm asks for
  /// no token.
  std::string owner{};
  /// The id of the token that it has joined with, by which at most `machines` workers may be here;
  /// empty: it has not joined.
  std::string joined_with{};
  uint32_t machines = 0;
};

}  // namespace hyades::coordinator
