#include "core/job/check_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace hyades::core {

namespace {

/// The first moment of `frame` for which `wrong` holds.
template <class Wrong>
std::optional<JobTime> first_moment(const Job& job, int32_t frame, bool in_shutter,
                                    const Wrong& wrong) {
  const int steps = in_shutter && job.frames.shutter > 0.0F ? kShutterMoments - 1 : 0;
  for (int i = 0; i <= steps; ++i) {
    const JobTime time =
        job.time_of(frame, steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0.0F);
    if (wrong(time)) return time;
  }
  return std::nullopt;
}

/// The square of the distance is what directions are divided by, and must be a normal float.
bool coincide(const VectorCheck& check, const JobTime& time) {
  const Vec3 between = check.value.at(time) - check.other.at(time);
  return glm::dot(between, between) < std::numeric_limits<float>::min();
}

template <class Check>
Status check_all(const Job& job, int32_t frame, const std::vector<Check>& checks) {
  for (const Check& check : checks) {
    if (const auto complaint = complaint_at(job, frame, check)) {
      return Error{complaint->to_string()};
    }
  }
  return {};
}

}  // namespace

std::optional<Diagnostic> complaint_at(const Job& job, int32_t frame, const NumberCheck& check) {
  const auto wrong = first_moment(job, frame, check.in_shutter, [&](const JobTime& time) {
    return !check.range.contains(check.expression->evaluate(time));
  });
  if (!wrong) return std::nullopt;
  const double value = check.expression->evaluate(*wrong);
  const std::string shown = std::isnan(value) ? "not a number" : fmt::format("{:.6g}", value);
  return Diagnostic{check.where, fmt::format("{} is {} at frame {:.10g}, expected {}", check.label,
                                             shown, wrong->frame, check.range.describe())};
}

std::optional<Diagnostic> complaint_at(const Job& job, int32_t frame, const VectorCheck& check) {
  const auto wrong = first_moment(job, frame, check.in_shutter,
                                  [&](const JobTime& time) { return coincide(check, time); });
  if (!wrong) return std::nullopt;
  const Vec3 value = check.value.at(*wrong);
  const std::string when = is_constant(check) ? "" : fmt::format(" at frame {:.10g}", wrong->frame);
  return Diagnostic{check.where,
                    fmt::format("{} [{:.6g}, {:.6g}, {:.6g}]{}, expected {}", check.label, value.x,
                                value.y, value.z, when, check.expected)};
}

bool is_constant(const NumberCheck& /*check*/) { return false; }

bool is_constant(const VectorCheck& check) {
  return check.value.is_constant() && check.other.is_constant();
}

Status check_frame(const Job& job, int32_t frame) {
  if (auto kept = check_all(job, frame, job.checks.numbers); !kept) return kept;
  return check_all(job, frame, job.checks.vectors);
}

}  // namespace hyades::core
