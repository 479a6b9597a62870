#include "core/job/read_context.h"

#include <fmt/format.h>

namespace hyades::core {

namespace {

constexpr uint64_t kMaxVisits = uint64_t{1} << 22;

}  // namespace

void ReadContext::complain(const SourceLocation& where, const std::string& message) {
  const Diagnostic complaint{where, message};
  if (diagnostics.full()) return;
  if (!complaints_.insert(complaint.to_string()).second) return;
  diagnostics.add(where, message);
}

bool ReadContext::spend(uint64_t nodes, const SourceLocation& where) {
  if (exhausted_) return false;
  spent_ += nodes;
  if (spent_ <= kMaxVisits) return true;
  exhausted_ = true;
  complain(where, fmt::format("the job unfolds to more than {} values (through `like`, `include` "
                              "and aliases); write large scenes as meshes or instances",
                              kMaxVisits));
  return false;
}

std::string ReadContext::job_relative(const std::string& reference,
                                      const SourceLocation& where) const {
  return resolve_reference(reference, origins.file_at(where));
}

}  // namespace hyades::core
