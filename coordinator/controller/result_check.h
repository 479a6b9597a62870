#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/controller/active_job.h"
#include "coordinator/controller/lease_proof.h"
#include "core/film/film.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// A result on its way through the scheduler.
struct Delivery {
  core::Film film;
  std::vector<std::byte> record;  ///< encode_delivered
  AcceptedUnit unit;
  FilmUnderWay rendered;
  bool settled = false;  ///< it is on its way to the disk, or was answered
};

/// What the film of a result has to be like, and whose.
struct ExpectedFilm {
  core::FilmLayout layout;
  core::PixelRect region;
  FrameKey key{};
  std::string worker;  ///< Hello::worker_id of who sends it
  std::string worker_class;
};

/// Why a result is not taken.
struct ResultRefusal {
  v1::Rejected::Reason reason = v1::Rejected::REASON_UNSPECIFIED;
  std::string text;             ///< for people
  uint32_t retry_after_ms = 0;  ///< with REASON_NOT_NOW: when the worker is to send it again
};

/// Checks what is known without the film: a proof that its unit was leased to the worker above all,
/// for what is said to be of a large tile may take much memory. `expected` is nothing where there
/// is no such job.
std::optional<ResultRefusal> check_claim(const v1::UnitResult& result,
                                         const std::optional<ExpectedFilm>& expected,
                                         const LeaseProofs& proofs);

/// Decodes a result for which check_claim() has found nothing wrong, and checks all that depends on
/// its bytes alone; slow.
std::variant<Delivery, ResultRefusal> check_result(const v1::UnitResult& result,
                                                   const ExpectedFilm& expected);

}  // namespace hyades::coordinator
