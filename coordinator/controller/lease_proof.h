#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "coordinator/scheduler/ids.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// Proofs that a unit was leased to a worker: it travels with the lease, comes back with the film,
/// and needs no memory of ours. So films are taken late, and over restarts, but never such as
/// nobody was asked for. A proof tells which batches were leased, as a worker that leaves may
/// deliver the first of them alone. It holds a code (HMAC-SHA-256, RFC 2104) of these batches, the
/// worker, the job, the frame and the tile. 128 bits of the code are enough.
class LeaseProofs {
 public:
  /// `secret`: of this farm (JobStore::secret()).
  explicit LeaseProofs(std::string secret) : secret_(std::move(secret)) {}

  /// The proof that the worker of this id (Hello::worker_id) has the unit.
  std::string make(const std::string& worker, JobId job, const core::Unit& unit) const;

  /// A number of the job's that workers cannot tell.
  uint64_t secret_number(JobId job) const;

  /// Whether `proof` is one that the worker has the unit, or one that it is part of.
  bool holds(const std::string& proof, const std::string& worker, JobId job,
             const core::Unit& unit) const;

 private:
  std::string code(const std::string& worker, JobId job, const core::Unit& unit) const;

  const std::string secret_;
};

}  // namespace hyades::coordinator
