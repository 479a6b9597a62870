#pragma once

#include <cstdint>
#include <string>

#include "farm/byte_budget.h"
#include "farm/token_term.h"
#include "hyades/v1/admin.pb.h"

namespace hyades::coordinator {

/// Caller::token_id of the token that --token-file gives, which is one for all.
inline constexpr const char* kSharedToken = "file";
/// Caller::token_id, in the audit log, of who works on a coordinator's folder itself (--data).
inline constexpr const char* kByFolder = "folder";
/// Caller::token_id, in the audit log, of what the coordinator does of itself.
inline constexpr const char* kByItself = "coordinator";
/// Caller::address of both.
inline constexpr const char* kThisMachine = "this machine";

/// Who calls.
struct Caller {
  std::string token_id;  ///< empty: the farm asks for none
  std::string name;      ///< of the token; empty: nobody in particular
  v1::Role role = v1::ROLE_UNSPECIFIED;
  std::string address;  ///< where the call comes from, for people
  farm::TokenTerm term{};
  std::string worker{};   ///< the only worker that may come with the token, a machine's; empty: any
  std::string pool{};     ///< StoredToken::pool
  uint32_t machines = 0;  ///< StoredToken::machines
  std::string session{};  ///< of a browser that has signed in: names it (Authority::end_session)
};

/// For whom bytes are counted that the caller has held: the name of his token, and, where that is
/// one machine's own, the machine; where he has none that part of the network that he comes from
/// (neighbourhood_of()).
farm::ByteBudget::Owner owner_of(const Caller& caller);

}  // namespace hyades::coordinator
