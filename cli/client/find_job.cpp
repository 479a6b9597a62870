#include "cli/client/find_job.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <set>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cli/client/show.h"
#include "cli/frame_range.h"
#include "core/base/text.h"
#include "farm/job_state.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostShown = 8;
constexpr size_t kMostCandidates = 10'000;  ///< for 'did you mean'

}  // namespace

Outcome select_frames(FarmClient& client, uint64_t id, const std::string& text,
                      std::vector<int32_t>& frames) {
  if (text.empty()) return std::nullopt;
  const auto ranges = parse_frame_list(text);
  if (!ranges) return Failure{kBadArguments, ranges.error().message};
  v1::GetJobResponse response;
  if (auto failure = client.get(id, response)) return failure;
  std::set<int32_t> known;
  for (const v1::Frame& frame : response.frames()) known.insert(frame.frame());
  std::set<int32_t> chosen;
  for (const FrameRange& range : *ranges) {
    for (int64_t frame = range.first; frame <= range.last; frame += range.step) {
      const auto number = static_cast<int32_t>(frame);
      if (!known.contains(number)) {
        return Failure{kUnknown, fmt::format("job {} has no frame {}", id, frame)};
      }
      chosen.insert(number);
    }
  }
  frames.assign(chosen.begin(), chosen.end());
  return std::nullopt;
}

Outcome list_all_jobs(FarmClient& client, bool ended, const std::string& owner,
                      std::vector<v1::Job>& jobs) {
  v1::ListJobsRequest request;
  request.set_ended(ended);
  request.set_owner(owner);
  v1::ListJobsResponse response;
  uint64_t bytes = 0;
  do {
    if (auto failure = client.call("Jobs/List", request, response)) return failure;
    if (auto failure = client.count_part(response, bytes)) return failure;
    jobs.insert(jobs.end(), response.jobs().begin(), response.jobs().end());
    if (request.before() != 0 && response.next_before() >= request.before()) {
      return Failure{kFailed, "the coordinator lists jobs whose numbers do not fall"};
    }
    request.set_before(response.next_before());
  } while (response.next_before() != 0 && response.jobs_size() > 0);
  return std::nullopt;
}

Outcome list_latest_jobs(FarmClient& client, size_t most, const std::string& owner,
                         std::vector<v1::Job>& jobs) {
  if (auto failure = list_all_jobs(client, false, owner, jobs)) return failure;
  v1::ListJobsRequest request;
  request.set_ended(true);
  request.set_owner(owner);
  request.set_limit(200);
  v1::ListJobsResponse response;
  if (auto failure = client.call("Jobs/List", request, response)) return failure;
  std::vector<v1::Job> over(response.jobs().begin(), response.jobs().end());
  std::erase_if(over, [](const v1::Job& job) { return !farm::has_ended(job); });
  const auto later = [](const v1::Job& a, const v1::Job& b) { return a.ended_ms() > b.ended_ms(); };
  std::sort(over.begin(), over.end(), later);
  over.resize(std::min(over.size(), most));
  jobs.insert(jobs.end(), over.begin(), over.end());
  const auto newer = [](const v1::Job& a, const v1::Job& b) { return a.id() > b.id(); };
  std::sort(jobs.begin(), jobs.end(), newer);
  return std::nullopt;
}

namespace {

/// Whether the job is one of those that `namesakes` means.
bool is_meant(const v1::Job& job, Namesakes namesakes) {
  switch (namesakes) {
    case Namesakes::none:
      return false;
    case Namesakes::open:
      return !farm::has_ended(job);
    case Namesakes::failed:
      return job.state() == v1::JOB_STATE_CANCELLED || job.state() == v1::JOB_STATE_FAILED ||
             job.frames_failed() > 0;
    case Namesakes::newest:
      return true;
  }
  return false;
}

const char* in_words(Namesakes namesakes) {
  return namesakes == Namesakes::newest ? "the newest"
         : namesakes == Namesakes::open ? "the only one that is open"
                                        : "the only one with something to retry";
}

}  // namespace

Outcome find_job(FarmClient& client, const std::string& text, Namesakes namesakes, uint64_t& id) {
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, id);
  if (error == std::errc() && last == end) return std::nullopt;

  std::vector<v1::Job> jobs;
  if (auto failure = list_all_jobs(client, true, "", jobs)) return failure;
  std::set<std::string> names;
  std::vector<uint64_t> ids;    // of all that are called so, the newest first
  std::vector<uint64_t> meant;  // of those that may be meant
  for (const v1::Job& job : jobs) {
    if (job.name() == text) {
      ids.push_back(job.id());
      if (is_meant(job, namesakes)) meant.push_back(job.id());
    }
    if (names.size() < kMostCandidates) names.insert(job.name());
  }
  if (ids.empty()) {
    const std::vector<std::string> candidates(names.begin(), names.end());
    const std::string hint = core::did_you_mean(text, candidates);
    return Failure{kUnknown, fmt::format("there is no job '{}'{}", text,
                                         hint.empty() ? " (hyades jobs --all lists them)" : hint)};
  }
  id = ids.front();
  if (ids.size() == 1) return std::nullopt;
  if (meant.size() == 1 || namesakes == Namesakes::newest) {
    id = meant.front();
    std::fprintf(stderr, "%zu jobs are called '%s': this is job %lu, %s\n", ids.size(),
                 core::printable(text).c_str(), id, in_words(namesakes));
    return std::nullopt;
  }
  const size_t shown = std::min(ids.size(), kMostShown);
  return Failure{
      kBadArguments,
      fmt::format("{} jobs are called '{}': say which by its id, {}{}", ids.size(), text,
                  fmt::join(ids.begin(), ids.begin() + static_cast<ptrdiff_t>(shown), ", "),
                  shown < ids.size() ? ", ..." : "")};
}

}  // namespace hyades::cli
