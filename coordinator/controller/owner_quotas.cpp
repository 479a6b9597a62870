#include "coordinator/controller/owner_quotas.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr double kNsPerHour = 3600e9;

std::string has(const std::string& owner) {
  return owner.empty() ? "those without a name have" : owner + " has";
}

}  // namespace

grpc::Status OwnerQuotas::may_upload(const std::string& owner, uint64_t size,
                                     const farm::UnfinishedFiles& others,
                                     uint64_t unclaimed) const {
  if (limits_.files > 0 && others.files >= limits_.files) {
    return farm::over_quota(fmt::format(
        "{} {}, as many as an owner may have here (--owner-files {}): go on with those, "
        "or come again when some have rested for a minute and give way",
        has(owner), core::counted(others.files, "unfinished upload"), limits_.files));
  }
  if (limits_.bytes == 0) return grpc::Status::OK;
  const std::string limit = core::format_bytes(limits_.bytes);
  if (size > limits_.bytes) {
    return farm::over_quota(
        fmt::format("a file of {}: an owner may have {} here that no job has had (--owner-bytes)",
                    core::format_bytes(size), limit));
  }
  const uint64_t bytes = others.bytes + unclaimed;
  if (bytes <= limits_.bytes - size) return grpc::Status::OK;
  return farm::over_quota(fmt::format(
      "{} {} of files here that are unfinished or that no job has had, and this one has {}, where "
      "an owner may have {} of them (--owner-bytes): submit their job, or come again when they "
      "have gone",
      has(owner), core::format_bytes(bytes), core::format_bytes(size), limit));
}

grpc::Status OwnerQuotas::may_add_job(const std::string& owner, uint64_t open) const {
  if (limits_.jobs == 0 || open < limits_.jobs) return grpc::Status::OK;
  return farm::over_quota(
      fmt::format("{} {}, as many as an owner may have here (--owner-jobs {}): wait for one to "
                  "end, or cancel one",
                  has(owner), core::counted(open, "open job"), limits_.jobs));
}

grpc::Status OwnerQuotas::may_hold(const std::string& owner, const JobRoom& his,
                                   const JobRoom& most) const {
  if (his.frames <= most.frames / 2 && his.bytes <= most.bytes / 2) return grpc::Status::OK;
  return farm::over_quota(fmt::format(
      "with this job {} {} and {} of what submissions name in open jobs, where an owner may have "
      "half of what there is for all, {} and {}: wait for one to end, or cancel one",
      has(owner), core::counted(his.frames, "frame"), core::format_bytes(his.bytes),
      core::counted(most.frames / 2, "frame"), core::format_bytes(most.bytes / 2)));
}

grpc::Status OwnerQuotas::may_render(const std::string& owner, uint64_t core_ns) const {
  const double hours = static_cast<double>(core_ns) / kNsPerHour;
  if (limits_.core_hours == 0 || hours < limits_.core_hours) return grpc::Status::OK;
  return farm::over_quota(
      fmt::format("{} had {:.1f} core-hours within {} hours, where an owner may have {:g} "
                  "(--owner-core-hours): jobs that are open go on, and new ones are taken in as "
                  "those hours pass",
                  has(owner), hours, kCoreHoursWindow.count(), limits_.core_hours));
}

grpc::Status OwnerQuotas::may_connect(const std::string& owner, uint64_t open) const {
  if (limits_.connections == 0 || open < limits_.connections) return grpc::Status::OK;
  return farm::over_quota(fmt::format(
      "{} {}, as many as an owner may have here (--owner-connections {}): end one, such "
      "as a page of the dashboard or a 'hyades watch'",
      has(owner), core::counted(open, "open stream"), limits_.connections));
}

}  // namespace hyades::coordinator
