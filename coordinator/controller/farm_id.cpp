#include "coordinator/controller/farm_id.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "farm/small_file.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDigits = 32;

/// Whether there is anything in the folder, if it is there.
bool holds_anything(const std::string& folder) {
  std::error_code failed;
  const fs::directory_iterator first(folder, failed);
  return !failed && first != fs::directory_iterator();
}

}  // namespace

core::Status claim_files(const std::string& files, const std::string& secret, bool was_ours) {
  const std::string file = files + "/farm-id";
  const std::string id = core::to_hex(core::sha256("farm " + secret)).substr(0, kDigits) + "\n";
  std::error_code unknown;
  if (fs::exists(file, unknown)) {
    const auto told = farm::read_small_file(file);
    if (!told) return told.error();
    if (*told == id) return {};
    return core::Error{files + " holds the files of another farm (" + file +
                       "): expected those of this one, or an empty folder"};
  }
  if (unknown) return core::Error{file + ": " + unknown.message()};
  const bool used = holds_anything(files + "/outputs") || holds_anything(files + "/assets");
  if (used && !was_ours) {
    return core::Error{files +
                       " holds assets or outputs, and nothing says that they are this farm's: "
                       "expected an empty folder, or 'hyades migrate' to bring its farm along"};
  }
  core::Status written = core::write_file(file, std::as_bytes(std::span(id)));
  // On a disk without a free byte a farm goes on to be what it was; the next start writes it.
  return was_ours ? core::Status() : written;
}

}  // namespace hyades::coordinator
