#pragma once

#include <chrono>
#include <compare>
#include <cstdint>

#include "core/base/duration.h"
#include "core/base/hash.h"

namespace hyades::coordinator {

using Duration = std::chrono::nanoseconds;
/// Only differences mean anything: the driver feeds a steady clock, the simulator its own.
using TimePoint = std::chrono::time_point<std::chrono::steady_clock, Duration>;

using core::seconds;

enum class JobId : uint64_t {};
enum class WorkerId : uint64_t {};
/// Who says what a worker says of a unit: it alone, or all workers of one credential, who are one
/// witness together. 0: nobody.
enum class Witness : uint64_t {};
/// The token or pool that a worker came by, which can bring any number of workers.
enum class Origin : uint64_t {};
/// A class of workers, whose bits agree, by the name that they give. 0: none yet.
enum class ClassId : uint64_t {};
/// What workers may have and jobs may want, by its name.
enum class TagId : uint64_t {};
/// A thing to be made durable; unique within one incarnation.
enum class RecordId : uint64_t {};

/// A lease's name. The incarnation is that of the coordinator that granted it, so that a lease from
/// before a restart is never taken for one of today.
struct LeaseId {
  uint64_t incarnation = 0;
  uint64_t number = 0;
  friend auto operator<=>(const LeaseId&, const LeaseId&) = default;
};

/// SHA-256 over a unit's film: two renderings of a unit by one class have the same.
using Digest = core::Sha256;

}  // namespace hyades::coordinator
