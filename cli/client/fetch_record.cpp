#include "cli/client/fetch_record.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <optional>
#include <span>
#include <utility>

#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::cli {
FetchRecord::FetchRecord(std::string folder) : file_(std::move(folder) + "/.hyades/fetched") {
  std::ifstream lines(file_);
  for (std::string line; std::getline(lines, line);) {
    if (!lines.eof()) paths_.insert(line);  // the last one may have been cut short
  }
}

Outcome FetchRecord::add(const std::string& path) {
  if (has(path)) return std::nullopt;
  // Beside where `hyades render` keeps its films.
  ::mkdir(file_.substr(0, file_.rfind('/')).c_str(), 0777);
  const std::string line = path + "\n";
  const core::Descriptor file = core::open_file(file_, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  if (!file.valid() || !core::write_all(file.get(), std::as_bytes(std::span(line)))) {
    return Failure{kFailed, "cannot write " + file_ + ": " + core::io_reason(errno)};
  }
  paths_.insert(path);
  return std::nullopt;
}

}  // namespace hyades::cli
