#include "coordinator/access/machine_key.h"

#include <unistd.h>

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
  // Under another name first: one that a crash has cut would keep the coordinator from starting.
  const std::string fresh = file + ".new";
  (void)::unlink(fresh.c_str());
  if (auto written = farm::write_secret(fresh, key + "\n"); !written) return written.error();
  std::filesystem::rename(fresh, file, failed);
  if (failed) return core::Error{file + ": cannot be made: " + failed.message()};
  return key;
}

}  // namespace hyades::coordinator
