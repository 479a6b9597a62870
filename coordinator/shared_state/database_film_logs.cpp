#include "coordinator/shared_state/database_film_logs.h"

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

constexpr std::string_view kFilms = "films/";

class DatabaseFilmLogs final : public FilmLogs {
 public:
  DatabaseFilmLogs(std::unique_ptr<DatabaseLogFiles> files, std::string scratch)
      : files_(std::move(files)), scratch_(std::move(scratch)), garbage_([this] {
          // Of what cannot be removed now the next leader takes care.
          (void)files_->remove_garbage();
        }) {}
  ~DatabaseFilmLogs() override { garbage_.join(); }

  LogFiles& files() override { return *files_; }
  std::string folder(uint64_t job) const override { return fmt::format("{}{}", kFilms, job); }
  std::string aside_folder(uint64_t job) const override {
    return fmt::format("{}/{}", scratch_, job);
  }

  core::Result<bool> contains(uint64_t job) override {
    const auto names = files_->list(folder(job));
    if (!names) return names.error();
    return !names->empty();
  }

  core::Result<std::vector<uint64_t>> jobs() override {
    const auto folders = files_->folders();
    if (!folders) return folders.error();
    std::vector<uint64_t> ids;
    for (const std::string& name : *folders) {
      if (!name.starts_with(kFilms)) continue;
      uint64_t id = 0;
      const char* const end = name.data() + name.size();
      const auto read = std::from_chars(name.data() + kFilms.size(), end, id);
      if (read.ec == std::errc() && read.ptr == end) ids.push_back(id);
    }
    return ids;
  }

  bool remove(uint64_t job, uint64_t most) override {
    const auto names = files_->list(folder(job));
    if (!names) return false;
    for (const std::string& name : *names) {
      if (most-- == 0) return false;
      if (!files_->remove(folder(job) + "/" + name)) return false;
    }
    return true;
  }

 private:
  const std::unique_ptr<DatabaseLogFiles> files_;
  const std::string scratch_;
  std::thread garbage_;
};

}  // namespace

std::unique_ptr<FilmLogs> database_film_logs(std::unique_ptr<DatabaseLogFiles> files,
                                             const std::string& scratch) {
  return std::make_unique<DatabaseFilmLogs>(std::move(files), scratch);
}

}  // namespace hyades::coordinator
