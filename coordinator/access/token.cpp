#include "coordinator/access/token.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <openssl/crypto.h>

#include "core/base/hash.h"
#include "core/base/random_id.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kPrefix = "hyades-";
constexpr size_t kIdDigits = 8;
constexpr size_t kSecretDigits = 64;
constexpr size_t kLongestName = 64;
constexpr uint32_t kMachines = 1000;  ///< that may join with a token where nobody says how many
constexpr int64_t kLongestLifetimeMs = int64_t{100} * 366 * 24 * 3600 * 1000;

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= kLongestName &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  std::string_view("-_.@").find(c) != std::string_view::npos;
         });
}

core::Status check(const v1::CreateTokenRequest& asked) {
  if (!is_name(asked.name())) {
    return core::Error{
        "name: expected 1 to 64 letters, digits, '-', '_', '.' or '@' (whose token it is)"};
  }
  if (asked.role() < v1::ROLE_VIEWER || asked.role() > v1::ROLE_ADMIN) {
    return core::Error{"role: expected viewer, submitter, operator, worker or admin"};
  }
  if (asked.lifetime_ms() < 0 || asked.lifetime_ms() > kLongestLifetimeMs) {
    return core::Error{"expires: expected a time of at most a hundred years, or never"};
  }
  if (asked.machines() != 0 && asked.role() != v1::ROLE_WORKER) {
    return core::Error{"machines: only workers' tokens have them"};
  }
  if (asked.pool().empty()) return {};
  if (asked.role() != v1::ROLE_WORKER) return core::Error{"pool: only a worker's token has one"};
  if (!is_name(asked.pool())) {
    return core::Error{"pool: expected 1 to 64 letters, digits, '-', '_', '.' or '@'"};
  }
  return {};
}

/// The code of a machine's token, in hexadecimal digits.
std::string machine_code(const std::string& key, const MachineToken& claim) {
  return core::to_hex(core::hmac_sha256(key, "machine " + claim.id + " " + claim.worker));
}

}  // namespace

core::Result<FreshToken> make_token(const v1::CreateTokenRequest& asked, int64_t now_ms) {
  if (core::Status sane = check(asked); !sane) return sane.error();
  std::string digits;
  while (digits.size() < kIdDigits + kSecretDigits) {
    const auto more = core::random_id();
    if (!more) return more.error();
    digits += *more;
  }
  FreshToken token;
  token.row.id = digits.substr(0, kIdDigits);
  token.text = std::string(kPrefix) + token.row.id + "-" + digits.substr(kIdDigits, kSecretDigits);
  token.row.name = asked.name();
  token.row.role = asked.role();
  token.row.hash = token_hash(token.text);
  token.row.created_ms = now_ms;
  token.row.expires_ms = asked.lifetime_ms() == 0 ? 0 : now_ms + asked.lifetime_ms();
  token.row.pool = asked.pool();
  if (asked.role() == v1::ROLE_WORKER) {
    token.row.machines = asked.machines() == 0 ? kMachines : asked.machines();
  }
  return token;
}

std::optional<std::string> token_id(std::string_view text) {
  if (text.size() != kPrefix.size() + kIdDigits + 1 + kSecretDigits || !text.starts_with(kPrefix) ||
      text[kPrefix.size() + kIdDigits] != '-') {
    return std::nullopt;
  }
  return std::string(text.substr(kPrefix.size(), kIdDigits));
}

std::string machine_token(const std::string& key, const MachineToken& claim) {
  if (!is_name(claim.worker)) return {};
  return std::string(kPrefix) + claim.id + "-" + machine_code(key, claim) + "-" + claim.worker;
}

std::optional<MachineToken> read_machine_token(const std::string& key, std::string_view text) {
  constexpr size_t kJoined = kPrefix.size() + kIdDigits + 1 + kSecretDigits;
  if (text.size() < kJoined + 2 || text[kJoined] != '-') return std::nullopt;
  const auto id = token_id(text.substr(0, kJoined));
  if (!id) return std::nullopt;
  MachineToken claim{*id, std::string(text.substr(kJoined + 1))};
  const std::string right = machine_token(key, claim);
  const bool same =
      right.size() == text.size() && CRYPTO_memcmp(right.data(), text.data(), text.size()) == 0;
  return same ? std::optional(std::move(claim)) : std::nullopt;
}

std::string token_hash(std::string_view text) {
  const core::Sha256 digest = core::sha256(text);
  return {digest.begin(), digest.end()};
}

bool is_live(const StoredToken& token, int64_t now_ms) {
  return token.revoked_ms == 0 && (token.expires_ms == 0 || now_ms < token.expires_ms);
}

v1::Token to_wire(const StoredToken& token) {
  v1::Token wire;
  wire.set_id(token.id);
  wire.set_name(token.name);
  wire.set_role(static_cast<v1::Role>(token.role));
  wire.set_created_ms(token.created_ms);
  wire.set_expires_ms(token.expires_ms);
  wire.set_used_ms(token.used_ms);
  wire.set_revoked_ms(token.revoked_ms);
  wire.set_pool(token.pool);
  if (token.role == v1::ROLE_WORKER) wire.set_machines(token.machines);
  return wire;
}

}  // namespace hyades::coordinator
