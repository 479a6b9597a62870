#include "coordinator/access/machine_key.h"

#include <filesystem>
#include <system_error>

#include "core/base/random_id.h"
#include "farm/channel.h"
#include "farm/small_file.h"

namespace hyades::coordinator {

core::Result<std::string> machine_key(const std::string& folder) {
  const std::string file = folder + "/machine-key";
  std::error_code failed;
  if (std::filesystem::exists(file, failed)) return farm::read_token(file);
  std::string key;
  while (key.size() < 64) {
    const auto more = core::random_id();
    if (!more) return more.error();
    key += *more;
  }
  // At once or not at all: one that a crash has cut would keep the coordinator from starting.
  if (auto written = farm::replace_secret(file, key + "\n"); !written) return written.error();
  return key;
}

}  // namespace hyades::coordinator
