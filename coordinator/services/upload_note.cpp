#include "coordinator/services/upload_note.h"

#include <fmt/format.h>

#include "coordinator/access/rules.h"

namespace hyades::coordinator {

void note_upload(AuditLog* log, const Caller& caller, const std::string& sha256, uint64_t size,
                 uint64_t begun) {
  if (log == nullptr) return;
  const std::string detail = begun == 0 ? fmt::format("{} bytes", size)
                                        : fmt::format("{} bytes, goes on from {}", size, begun);
  log->upload(caller, rule_of_method("Assets/Upload").deed, sha256, detail);
}

}  // namespace hyades::coordinator
