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

/// Makes a token as it is asked for. Errors:
/// - the name, or a pool, is not 1 to 64 letters, digits, '-', '_', '.' or '@';
/// - the role is none, or another role than a worker's has a pool or machines;
/// - the lifetime is negative, or longer than a hundred years;
/// - the system gives no random numbers.
core::Result<FreshToken> make_token(const v1::CreateTokenRequest& asked, int64_t now_ms);

/// The public part of a token; nothing where `text` is none of this farm's kind.
std::optional<std::string> token_id(std::string_view text);

/// The SHA-256 of a token: 32 bytes.
std::string token_hash(std::string_view text);

// A machine's token is "hyades-ID-CODE-WORKER": the id of the token with which it has joined, a
// code (HMAC-SHA-256, RFC 2104) of that and of its worker's id, as 64 hexadecimal digits, and the
// worker's id. It needs no memory of ours, and holds as long as the token it was made from.

/// What a machine's token claims.
struct MachineToken {
  std::string id;      ///< of the token that the machine has joined with
  std::string worker;  ///< Hello::worker_id of the one worker that may show it
};

/// The token of this worker's machine; empty where the worker's id has other characters than names
/// of tokens. `key`: of the farm, and secret.
std::string machine_token(const std::string& key, const MachineToken& claim);

/// What the token claims where it is a machine's and its code is right.
std::optional<MachineToken> read_machine_token(const std::string& key, std::string_view text);

/// Whether the token may be used at that time: it is not revoked and has not expired.
bool is_live(const StoredToken& token, int64_t now_ms);

/// The token as the wire shows it: all but the hash.
v1::Token to_wire(const StoredToken& token);

}  // namespace hyades::coordinator
