// Whether any worker has what a job asks for, and where its units are.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/diagnosis.h"
#include "coordinator/controller/lease_renewal.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostNamed = 8;
constexpr size_t kMostStillUnits = 8;  ///< that are listed

using Stage = v1::LeaseProgress::Stage;

/// What is said of units that are leased, by what their worker last said of them.
constexpr std::pair<Stage, const char*> kStages[] = {
    {v1::LeaseProgress::STAGE_RENDERING, "being rendered"},
    {v1::LeaseProgress::STAGE_LOADING, "waiting for their scene to be loaded"},
    {v1::LeaseProgress::STAGE_WAITING, "waiting for a thread"},
    {v1::LeaseProgress::STAGE_FETCHING, "waiting for the job's files"},
    {v1::LeaseProgress::STAGE_FILM, "rendered, their films on the way"},
};

bool has_tag(const v1::Hello& hello, const std::string& tag) {
  return std::find(hello.tags().begin(), hello.tags().end(), tag) != hello.tags().end();
}

bool has_memory(const v1::Hello& hello, uint64_t bytes) {
  return hello.memory_bytes() == 0 || hello.memory_bytes() >= bytes;
}

}  // namespace

/// Whether a worker is there that could take units.
bool Diagnosis::anybody() const {
  return std::any_of(workers_.all().begin(), workers_.all().end(),
                     [](const auto& entry)
                         HYADES_REQUIRES(state_lock) { return entry.second.may_take_units(); });
}

/// Why none of the workers that could take units may take this job's; nothing where one may, or
/// where it asks for nothing.
std::string Diagnosis::unmet_needs(const JobNeeds& job) const {
  if (!job.any()) return {};
  uint64_t most_memory = 0;
  bool enough_memory = false;
  bool portable = job.render_class == core::RenderClass::native;
  bool suits = false;
  std::vector<std::string> missing = job.tags;
  for (const auto& entry : workers_.all()) {
    const WorkerSession& session = entry.second;
    if (!session.may_take_units()) continue;
    const v1::Hello& hello = session.hello;
    const auto has = [&](const std::string& tag)
                         HYADES_REQUIRES(state_lock) { return has_tag(hello, tag); };
    std::erase_if(missing, has);
    most_memory = std::max(most_memory, hello.memory_bytes());
    const bool memory = has_memory(hello, job.memory);
    enough_memory |= memory;
    const bool renders =
        job.render_class == core::RenderClass::native || !hello.portable_class().empty();
    portable |= renders;
    suits |= renders && memory && std::all_of(job.tags.begin(), job.tags.end(), has);
  }
  if (suits) return {};
  if (!missing.empty()) {
    return fmt::format("it asks for workers with the tag '{}', and none is there", missing.front());
  }
  if (!portable) {
    return "it is rendered in the portable class, and no worker is there that knows it: their "
           "programs are too old";
  }
  if (!enough_memory && most_memory == 0) {
    return fmt::format("it asks for workers with {} of memory, and none is there",
                       core::format_bytes(job.memory));
  }
  if (!enough_memory) {
    return fmt::format("it asks for workers with {} of memory; the most that one has is {}",
                       core::format_bytes(job.memory), core::format_bytes(most_memory));
  }
  return job.render_class == core::RenderClass::portable
             ? "no worker has all its tags, the memory that it asks for and a portable class"
             : "no worker has both all its tags and the memory that it asks for";
}

/// Workers that are there and get nothing, and why; the first few.
std::vector<std::string> Diagnosis::barred_workers() const {
  std::vector<std::string> words;
  size_t others = 0;
  for (const auto& [worker, session] : workers_.all()) {
    if (!session.joined || session.state == v1::WORKER_STATE_ACTIVE) continue;
    if (words.size() == kMostNamed) {
      ++others;
      continue;
    }
    const std::string because =
        session.reason.empty() ? std::string() : " (" + session.reason + ")";
    words.push_back(session.state == v1::WORKER_STATE_QUARANTINED
                        ? fmt::format("worker {} is in quarantine{}; 'release' ends that",
                                      session.hello.name(), because)
                        : fmt::format("worker {} delivers what it has and leaves{}",
                                      session.hello.name(), because));
  }
  if (others > 0)
    words.push_back(core::counted(others, "more worker") + " in quarantine or leaving");
  return words;
}

/// What workers last said of the units that they have of the job, in one line; nothing where they
/// have none.
std::vector<std::string> Diagnosis::where_units_are(JobId job) const {
  std::map<Stage, uint32_t> told;
  uint32_t away = 0;
  uint32_t silent = 0;
  const auto units = dispatcher_.scheduler().units_of(job);
  for (const auto& [worker, held] : units) {
    const auto session = workers_.all().find(worker);
    if (session == workers_.all().end() || !session->second.link) {
      ++away;
      continue;
    }
    const auto progress = session->second.progress.find(held.lease);
    ++(progress == session->second.progress.end() ? silent : told[progress->second.stage]);
  }
  if (units.empty()) return {};
  std::vector<std::string> parts;
  const auto add = [&](uint32_t count, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
  };
  for (const auto& [stage, what] : kStages) {
    const auto count = told.extract(stage);
    if (count) add(count.mapped(), what);
  }
  for (const auto& [unknown, count] : told) silent += count;
  add(away, "with workers whose connection is lost");
  const std::string all = core::counted(units.size(), "unit") + " with workers";
  if (parts.empty()) return {all};  // they tell of them in a moment
  add(silent, "of which they tell in a moment");
  return {fmt::format("{}: {}", all, fmt::join(parts, ", "))};
}

/// Units of the job that get no further, in words.
std::vector<std::string> Diagnosis::still_units(JobId job) const {
  std::vector<std::string> words;
  for (const auto& [id, session] : workers_.all()) {
    for (const auto& [lease, progress] : session.progress) {
      const auto patience = lease_patience(progress.stage, context_.options.stall_time);
      if (!patience || progress.still < *patience / 4) continue;
      for (const UnitInHand& held : dispatcher_.scheduler().units_of(id, lease)) {
        if (held.job != job || words.size() == kMostStillUnits) continue;
        words.push_back(fmt::format(
            "worker {} has made no progress for {:.3g} s with tile {},{} of frame {}; after {:.3g} "
            "s it is taken from it",
            session.hello.name(), std::chrono::duration<double>(progress.still).count(),
            held.unit.tile.x0, held.unit.tile.y0, held.unit.frame,
            std::chrono::duration<double>(*patience).count()));
      }
    }
  }
  return words;
}

}  // namespace hyades::coordinator
