#include "coordinator/controller/lease_proof.h"

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>
#include <openssl/crypto.h>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kCode = 16;
constexpr size_t kNumber = 4;

void put(std::string& bytes, uint32_t number) {
  for (size_t i = 0; i < kNumber; ++i) bytes += static_cast<char>(number >> (8 * i));
}

uint32_t number_at(const std::string& bytes, size_t at) {
  uint32_t number = 0;
  for (size_t i = 0; i < kNumber; ++i) {
    number |= uint32_t{static_cast<uint8_t>(bytes[at + i])} << (8 * i);
  }
  return number;
}

}  // namespace

std::string LeaseProofs::code(const std::string& worker, JobId job, const core::Unit& unit) const {
  // The worker's id comes last: it alone has no fixed length.
  const std::string claim = fmt::format(
      "lease {} {} {} {} {} {} {} {} {}", static_cast<uint64_t>(job), unit.frame, unit.tile.x0,
      unit.tile.y0, unit.tile.x1, unit.tile.y1, unit.batches.first, unit.batches.count, worker);
  const core::Sha256 whole = core::hmac_sha256(secret_, claim);
  return {reinterpret_cast<const char*>(whole.data()), kCode};
}

std::string LeaseProofs::make(const std::string& worker, JobId job, const core::Unit& unit) const {
  std::string proof = code(worker, job, unit);
  put(proof, unit.batches.first);
  put(proof, unit.batches.count);
  return proof;
}

uint64_t LeaseProofs::secret_number(JobId job) const {
  const core::Sha256 whole =
      core::hmac_sha256(secret_, fmt::format("number {}", static_cast<uint64_t>(job)));
  uint64_t number = 0;
  for (size_t i = 0; i < sizeof number; ++i) number = (number << 8U) | whole[i];
  return number;
}

bool LeaseProofs::holds(const std::string& proof, const std::string& worker, JobId job,
                        const core::Unit& unit) const {
  if (proof.size() != kCode + 2 * kNumber) return false;
  core::Unit leased = unit;
  leased.batches = {number_at(proof, kCode), number_at(proof, kCode + kNumber)};
  const bool part = unit.batches.first >= leased.batches.first &&
                    uint64_t{unit.batches.first} + unit.batches.count <=
                        uint64_t{leased.batches.first} + leased.batches.count;
  return part && CRYPTO_memcmp(proof.data(), code(worker, job, leased).data(), kCode) == 0;
}

}  // namespace hyades::coordinator
