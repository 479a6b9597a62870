// Whether any worker has what a job asks for.
#include <algorithm>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

bool has_tag(const v1::Hello& hello, const std::string& tag) {
  return std::find(hello.tags().begin(), hello.tags().end(), tag) != hello.tags().end();
}

bool has_memory(const v1::Hello& hello, uint64_t bytes) {
  return hello.memory_bytes() == 0 || hello.memory_bytes() >= bytes;
}

}  // namespace

/// Why none of the workers that could take units may take this job's; nothing where one may.
std::string Brain::unmet_needs(const StoredJob& job) const {
  uint64_t most_memory = 0;
  bool enough_memory = false;
  bool suits = false;
  std::vector<std::string> missing = job.tags;
  for (const auto& [worker, seat] : seats_) {
    if (!seat.joined || seat.state != v1::WORKER_STATE_ACTIVE) continue;
    std::erase_if(missing, [&](const std::string& tag) { return has_tag(seat.hello, tag); });
    most_memory = std::max(most_memory, seat.hello.memory_bytes());
    const bool memory = has_memory(seat.hello, job.memory);
    enough_memory |= memory;
    suits |= memory && std::all_of(job.tags.begin(), job.tags.end(), [&](const std::string& tag) {
               return has_tag(seat.hello, tag);
             });
  }
  if (suits) return {};
  if (!missing.empty()) {
    return fmt::format("it asks for workers with the tag '{}', and none is there", missing.front());
  }
  if (!enough_memory) {
    return fmt::format("it asks for workers with {} of memory; the most that one has is {}",
                       core::format_bytes(job.memory), core::format_bytes(most_memory));
  }
  return "no worker has both all its tags and the memory that it asks for";
}

}  // namespace hyades::coordinator
