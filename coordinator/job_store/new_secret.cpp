#include "coordinator/job_store/new_secret.h"

#include "core/base/random_id.h"

namespace hyades::coordinator {

core::Result<std::string> new_secret() {
  const auto one = core::random_id();
  if (!one) return one;
  const auto other = core::random_id();
  if (!other) return other;
  return *one + *other;
}

}  // namespace hyades::coordinator
