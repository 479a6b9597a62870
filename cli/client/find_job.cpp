#include "cli/client/find_job.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostShown = 8;

}  // namespace

Outcome list_all_jobs(FarmClient& client, bool ended, const std::string& owner,
                      std::vector<v1::Job>& jobs) {
  v1::ListJobsRequest request;
  request.set_ended(ended);
  request.set_owner(owner);
  v1::ListJobsResponse response;
  do {
    if (auto failure = client.list(request, response)) return failure;
    jobs.insert(jobs.end(), response.jobs().begin(), response.jobs().end());
    request.set_before(response.next_before());
  } while (response.next_before() != 0);
  return std::nullopt;
}

Outcome find_job(FarmClient& client, const std::string& text, uint64_t& id) {
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, id);
  if (error == std::errc() && last == end) return std::nullopt;

  std::vector<v1::Job> jobs;
  if (auto failure = list_all_jobs(client, true, "", jobs)) return failure;
  std::vector<std::string> names;
  std::vector<std::string> ids;
  for (const v1::Job& job : jobs) {
    if (job.name() == text) {
      id = job.id();
      ids.push_back(std::to_string(job.id()));
    }
    if (std::find(names.begin(), names.end(), job.name()) == names.end()) {
      names.push_back(job.name());
    }
  }
  if (ids.size() == 1) return std::nullopt;
  if (ids.empty()) {
    return Failure{kUnknown,
                   fmt::format("there is no job '{}'{}", text, core::did_you_mean(text, names))};
  }
  const size_t shown = std::min(ids.size(), kMostShown);
  return Failure{
      kUnknown,
      fmt::format("{} jobs are called '{}': say which by its id, {}{}", ids.size(), text,
                  fmt::join(ids.begin(), ids.begin() + static_cast<ptrdiff_t>(shown), ", "),
                  shown < ids.size() ? ", ..." : "")};
}

}  // namespace hyades::cli
