#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "coordinator/controller/delivery.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// What the films of a job are like.
struct ExpectedFilm {
  core::FilmLayout layout;
  core::PixelRect region;
  FrameKey key{};
};

/// Why a result is not taken.
struct ResultRefusal {
  v1::Rejected::Reason reason = v1::Rejected::REASON_UNSPECIFIED;
  std::string text;
  uint32_t retry_after_ms = 0;
};

/// Decodes a result and checks all that depends on its bytes alone, which takes its time.
/// `expected` is nothing where there is no such job; `worker_class` is that of who sends it.
std::variant<Delivery, ResultRefusal> check_result(const v1::UnitResult& result,
                                                   const std::optional<ExpectedFilm>& expected,
                                                   const std::string& worker_class);

}  // namespace hyades::coordinator
