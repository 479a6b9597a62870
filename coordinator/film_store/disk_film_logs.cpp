#include "coordinator/film_store/disk_film_logs.h"

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/film_store/remove_folder.h"

namespace hyades::coordinator {
namespace {

class DiskFilmLogs final : public FilmLogs {
 public:
  explicit DiskFilmLogs(std::string folder) : folder_(std::move(folder)) {}

  LogFiles& files() override { return disk_log_files(); }
  std::string folder(uint64_t job) const override { return fmt::format("{}/{}", folder_, job); }
  std::string aside_folder(uint64_t /*job*/) const override { return {}; }

  core::Result<bool> contains(uint64_t job) override {
    std::error_code unknown;
    const bool there = std::filesystem::exists(folder(job), unknown);
    if (unknown) return core::Error{folder(job) + ": " + unknown.message()};
    return there;
  }
  core::Result<std::vector<uint64_t>> jobs() override { return numbered_folders(folder_); }
  bool remove(uint64_t job, uint64_t most) override { return remove_some(folder(job), most); }

 private:
  const std::string folder_;
};

}  // namespace

std::unique_ptr<FilmLogs> disk_film_logs(const std::string& folder) {
  return std::make_unique<DiskFilmLogs>(folder);
}

}  // namespace hyades::coordinator
