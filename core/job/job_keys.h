#pragma once

#include <compare>
#include <set>
#include <string>

namespace hyades::core {

/// A key that the reader of a job knows: "fov" in section "camera". Sections are those of
/// docs/job.md: "job" is the top level, "materials.conductor" what only a conductor takes.
struct JobKey {
  std::string section;
  std::string key;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 misreads defaulted comparisons
  friend auto operator<=>(const JobKey&, const JobKey&) = default;
};

/// Every key that the readers ask for, found by letting them read an empty job of every type. For
/// the test that holds docs/job.md against the code.
std::set<JobKey> known_job_keys();

}  // namespace hyades::core
