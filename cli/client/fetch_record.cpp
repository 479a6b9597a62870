#include "cli/client/fetch_record.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::cli {
FetchRecord::FetchRecord(std::string folder) : file_(std::move(folder) + "/.hyades/fetched") {
  // What is a link, or a pipe, came with somebody's folder.
  namespace fs = std::filesystem;
  std::error_code none;
  const auto type_of = [&](const fs::path& path) { return fs::symlink_status(path, none).type(); };
  const fs::file_type own = type_of(fs::path(file_).parent_path());
  const fs::file_type file = type_of(file_);
  is_plain_ = (own == fs::file_type::directory || own == fs::file_type::not_found) &&
              (file == fs::file_type::regular || file == fs::file_type::not_found);
  if (!is_plain_ || file != fs::file_type::regular) return;
  std::ifstream lines(file_);
  for (std::string line; std::getline(lines, line);) {
    if (!lines.eof()) lines_.insert(line);  // the last one may have been cut short
  }
}

Outcome FetchRecord::add(const std::string& job, const std::string& path,
                         const std::string& sha256) {
  if (has(job, path, sha256)) return std::nullopt;
  if (!is_plain_) {
    return Failure{
        kFailed, file_ + ": no plain file in a plain folder, expected what hyades has made there"};
  }
  // Beside where `hyades render` keeps its films.
  ::mkdir(file_.substr(0, file_.rfind('/')).c_str(), 0777);
  const std::string line = line_of(job, path, sha256) + "\n";
  const core::Descriptor file = core::open_file(file_, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  if (!file.valid() || !core::write_all(file.get(), std::as_bytes(std::span(line)))) {
    return Failure{kFailed, "cannot write " + file_ + ": " + core::io_reason(errno)};
  }
  lines_.insert(line.substr(0, line.size() - 1));
  return std::nullopt;
}

}  // namespace hyades::cli
