#include "core/job/render_key.h"

#include <cstdint>

#include "core/base/hash.h"
#include "core/job/resolved_text.h"

namespace hyades::core {

std::string render_key(const Job& job, int32_t frame, const std::vector<AssetRecord>& assets) {
  return to_hex(sha256(resolved_job_text(job, frame, assets)));
}

}  // namespace hyades::core
