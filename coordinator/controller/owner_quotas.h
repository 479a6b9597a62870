#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_options.h"
#include "farm/content_store.h"

namespace hyades::coordinator {

/// Within which OwnerLimits::core_hours are counted.
inline constexpr std::chrono::hours kCoreHoursWindow{24};

/// Whether an owner may have more of the farm than now: OK, or RESOURCE_EXHAUSTED
/// (farm::over_quota) in words that name the option and what helps. Counts nothing itself.
class OwnerQuotas {
 public:
  explicit OwnerQuotas(const OwnerLimits& limits) : limits_(limits) {}

  /// Whether a file of `size` bytes may be uploaded beside the owner's other unfinished ones, and
  /// `unclaimed` bytes of whole ones that no job has had.
  grpc::Status may_upload(const std::string& owner, uint64_t size,
                          const farm::UnfinishedFiles& others, uint64_t unclaimed) const;
  /// Whether a job may come to `open` ones that are not over.
  grpc::Status may_add_job(const std::string& owner, uint64_t open) const;
  /// Whether a job may come with which all of the owner's are `his`, where all owners together have
  /// at `most` so much.
  grpc::Status may_hold(const std::string& owner, const JobRoom& his, const JobRoom& most) const;
  /// Whether a job may come where the owner's jobs took `core_ns` within the window.
  grpc::Status may_render(const std::string& owner, uint64_t core_ns) const;
  /// Whether a stream may be opened beside `open` ones.
  grpc::Status may_connect(const std::string& owner, uint64_t open) const;

  /// Whether anybody has to count these.
  bool limits_bytes() const { return limits_.bytes > 0; }
  bool limits_core_hours() const { return limits_.core_hours > 0; }

 private:
  const OwnerLimits limits_;
};

}  // namespace hyades::coordinator
