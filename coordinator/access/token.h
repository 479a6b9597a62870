#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coordinator/job_store/job_store.h"
#include "core/base/result.h"
#include "hyades/v1/admin.pb.h"

namespace hyades::coordinator {

// A token is "hyades-ID-SECRET": a public id of 8 hexadecimal digits, and 256 random bits as 64
// hexadecimal digits. What is stored is its SHA-256. A slow hash (bcrypt, argon2) slows down who
// guesses passwords, which people choose; 256 random bits nobody guesses, and every call of the
// farm is checked.

/// A token that has just been made, and what is stored of it.
struct FreshToken {
  std::string text;  ///< shown once, kept nowhere
  StoredToken row;
};

/// Makes a token. `lifetime_ms` 0: it does not expire. An error where check_token() has one, or the
/// system gives no random numbers.
core::Result<FreshToken> make_token(const std::string& name, v1::Role role, int64_t lifetime_ms,
                                    int64_t now_ms);

/// OK, or an error where the name is not 1 to 64 letters, digits, '-', '_', '.' or '@', the role is
/// none, or the lifetime is negative or longer than a hundred years.
core::Status check_token(const std::string& name, v1::Role role, int64_t lifetime_ms);

/// The public part of a token; nothing where `text` is none of this farm's kind.
std::optional<std::string> token_id(std::string_view text);

/// The SHA-256 of a token: 32 bytes.
std::string token_hash(std::string_view text);

/// Whether the token may be used at that time: it is not revoked and has not expired.
bool is_live(const StoredToken& token, int64_t now_ms);

/// The token as the wire shows it: all but the hash.
v1::Token to_wire(const StoredToken& token);

}  // namespace hyades::coordinator
