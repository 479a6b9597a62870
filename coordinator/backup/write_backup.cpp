#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "coordinator/backup/backup.h"
#include "coordinator/backup/copy_database.h"
#include "coordinator/backup/manifest.h"
#include "coordinator/backup/read_file.h"
#include "coordinator/film_store/log_names.h"
#include "core/base/atomic_file.h"
#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr int kReadTries = 20;

/// A tar file in the making.
class Tar {
 public:
  ~Tar() {
    if (archive_ != nullptr) archive_write_free(archive_);
  }
  Tar() = default;
  Tar(const Tar&) = delete;
  Tar& operator=(const Tar&) = delete;

  /// For its owner alone: it holds unfinished pictures, scenes, and the hashes of tokens.
  core::Status open(const std::string& path) {
    file_ = core::open_file(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (!file_.valid()) return core::Error{"cannot write " + path + ": " + core::io_reason(errno)};
    archive_ = archive_write_new();
    if (archive_ == nullptr) return core::Error{"no memory"};
    // Names are the bytes that they are, whatever the locale.
    const bool ready = archive_write_set_format_pax_restricted(archive_) == ARCHIVE_OK &&
                       archive_write_set_options(archive_, "hdrcharset=BINARY") == ARCHIVE_OK &&
                       archive_write_add_filter_none(archive_) == ARCHIVE_OK &&
                       archive_write_open_fd(archive_, file_.get()) == ARCHIVE_OK;
    return ready ? core::Status() : trouble();
  }

  core::Status begin(const std::string& name, uint64_t size) {
    const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(),
                                                                              archive_entry_free);
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(size));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0600);
    archive_entry_set_mtime(entry.get(), std::time(nullptr), 0);
    return archive_write_header(archive_, entry.get()) == ARCHIVE_OK ? core::Status() : trouble();
  }

  core::Status add(std::span<const std::byte> bytes) {
    const auto written = archive_write_data(archive_, bytes.data(), bytes.size());
    return written == static_cast<la_ssize_t>(bytes.size()) ? core::Status() : trouble();
  }

  core::Status close() {
    return archive_write_close(archive_) == ARCHIVE_OK ? core::Status() : trouble();
  }

 private:
  core::Error trouble() const {
    const char* words = archive_error_string(archive_);
    return {words != nullptr ? words : "the tar file could not be written"};
  }
  core::Descriptor file_;
  archive* archive_ = nullptr;
};

class Writer {
 public:
  Writer(std::string data, std::string work) : data_(std::move(data)), work_(std::move(work)) {}

  core::Status write(const std::string& to) {
    if (auto opened = tar_.open(to); !opened) return opened;
    if (auto films = add_films(); !films) return films;
    const std::string copy = work_ + "/state.db";
    if (auto copied = copy_database(data_ + "/state.db", copy); !copied) return copied;
    if (auto added = add(copy, "state.db"); !added) return added;
    if (fs::exists(data_ + "/state.db.starts")) {
      if (auto added = add(data_ + "/state.db.starts", "state.db.starts"); !added) return added;
    }
    for (const char* folder : {"outputs", "assets"}) {
      if (auto added = add_folder(folder); !added) return added;
    }
    if (auto added = add_audit(); !added) return added;
    const std::string list = write_manifest(manifest_);
    if (auto begun = tar_.begin(kManifestName, list.size()); !begun) return begun;
    if (auto added = tar_.add(std::as_bytes(std::span(list))); !added) return added;
    return tar_.close();
  }

  BackupCount count() const {
    BackupCount count;
    for (const auto& [path, file] : manifest_.files) count.bytes += file.size;
    count.files = manifest_.files.size();
    count.left_out = left_out_;
    return count;
  }

 private:
  /// Regular files below a folder of the data, in order of their names.
  std::vector<std::string> files_below(const std::string& folder) const {
    std::vector<std::string> files;
    std::error_code failed;
    const fs::path top = fs::path(data_) / folder;
    for (fs::recursive_directory_iterator it(top, failed), end; !failed && it != end;
         it.increment(failed)) {
      std::error_code gone;
      if (it->is_regular_file(gone) && !it->is_symlink(gone)) {
        files.push_back(it->path().lexically_relative(data_).string());
      }
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  /// The segments of a job's log, oldest first, as long as they are now: a prefix of what was
  /// appended. Where the log was rewritten meanwhile, its folder is read once more.
  core::Status add_films() {
    std::error_code none;
    std::vector<std::string> jobs;
    for (fs::directory_iterator it(fs::path(data_) / "films", none), end; !none && it != end;
         it.increment(none)) {
      if (it->is_directory()) jobs.push_back(it->path().filename().string());
    }
    std::sort(jobs.begin(), jobs.end());
    for (const std::string& job : jobs) {
      if (auto added = add_log("films/" + job); !added) return added;
    }
    return {};
  }

  core::Status add_log(const std::string& folder) {
    for (int i = 0; i < kReadTries; ++i) {
      const auto names = log_files(folder);
      // Copied first, so that a log that is rewritten meanwhile leaves nothing in the tar file.
      const std::string copies = work_ + "/log";
      fs::remove_all(copies);
      fs::create_directories(copies);
      bool same = true;
      for (const std::string& name : names) {
        std::error_code gone;
        fs::copy_file(fs::path(data_) / name, fs::path(copies) / fs::path(name).filename(), gone);
        if (gone && gone != std::errc::no_such_file_or_directory) {
          return core::Error{name + ": " + gone.message()};
        }
        same = same && !gone;
      }
      const auto after = log_files(folder);
      same = same && std::includes(after.begin(), after.end(), names.begin(), names.end());
      if (!same) continue;
      for (const std::string& name : names) {
        if (auto added = add(copies + "/" + fs::path(name).filename().string(), name); !added) {
          return added;
        }
      }
      return {};
    }
    return core::Error{folder + ": it was rewritten while it was copied, again and again"};
  }

  /// Who did what: the files of that log as they are now, the oldest first, each with what tells it
  /// from another.
  std::vector<std::pair<std::string, ino_t>> audit_files() const {
    std::vector<std::pair<std::string, ino_t>> files;
    std::error_code none;
    for (fs::directory_iterator it(data_, none), end; !none && it != end; it.increment(none)) {
      const std::string name = it->path().filename().string();
      struct stat facts {};
      if (is_audit_file(name) && ::lstat(it->path().c_str(), &facts) == 0 &&
          S_ISREG(facts.st_mode)) {
        files.emplace_back(name, facts.st_ino);
      }
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  /// Files are only ever appended to, or renamed all at once when one has become large: then they
  /// are copied once more. The last line may be cut, as after a crash.
  core::Status add_audit() {
    const std::string copies = work_ + "/audit";
    for (int i = 0; i < kReadTries; ++i) {
      const auto files = audit_files();
      fs::remove_all(copies);
      fs::create_directories(copies);
      for (const auto& [name, identity] : files) {
        std::error_code gone;
        fs::copy_file(fs::path(data_) / name, fs::path(copies) / name, gone);
        if (gone && gone != std::errc::no_such_file_or_directory) {
          return core::Error{name + ": " + gone.message()};
        }
      }
      if (audit_files() != files) continue;
      for (const auto& [name, identity] : files) {
        if (auto added = add(copies + "/" + name, name); !added) return added;
      }
      return {};
    }
    return core::Error{"the audit log was begun anew while it was copied, again and again"};
  }

  std::vector<std::string> log_files(const std::string& folder) const {
    auto files = files_below(folder);
    std::erase_if(files, [](const std::string& file) {
      return file.ends_with(kUnfinishedSuffix) || file.ends_with(kLockName) ||
             file.ends_with(kAsideSuffix);
    });
    return files;
  }

  core::Status add_folder(const std::string& folder) {
    for (const std::string& file : files_below(folder)) {
      const std::string name = fs::path(file).filename().string();
      if (file.starts_with("assets/partial/") || name.ends_with(".tmp")) continue;
      if (!is_backup_path(file)) {  // of nobody's job
        left_out_.push_back(file);
        continue;
      }
      if (auto added = add(data_ + "/" + file, file, true); !added) return added;
    }
    return {};
  }

  /// `may_go`: a file that is no more there was needed by nobody.
  core::Status add(const std::string& path, const std::string& name, bool may_go = false) {
    std::error_code failed;
    const uint64_t size = fs::file_size(path, failed);
    if (failed == std::errc::no_such_file_or_directory && may_go) return {};
    if (failed) return core::Error{path + ": " + failed.message()};
    if (auto begun = tar_.begin(name, size); !begun) return begun;
    core::Sha256Stream digest;
    core::Status written;
    const auto read = read_file(path, size, [&](std::span<const std::byte> bytes) {
      digest.add(bytes);
      written = tar_.add(bytes);
      return written.ok();
    });
    if (!read) return read;
    if (!written) return written;
    const core::Sha256 sum = digest.digest();
    manifest_.files[name] = {size, core::to_hex(sum)};
    return {};
  }

  const std::string data_;
  const std::string work_;
  Tar tar_;
  Manifest manifest_;
  std::vector<std::string> left_out_;
};

}  // namespace

core::Result<BackupCount> write_backup(const std::string& data, const std::string& to) {
  if (!fs::exists(data + "/state.db")) {
    return core::Error{data + ": expected the folder of a coordinator (there is no state.db)"};
  }
  BackupCount count;
  const std::string work = to + ".work-" + std::to_string(::getpid());
  std::error_code ignored;
  fs::remove_all(work, ignored);  // of one with our number that was killed: in containers all are 1
  if (::mkdir(work.c_str(), 0700) != 0) {
    return core::Error{work + ": cannot be made: " + core::io_reason(errno)};
  }
  const core::Status written = core::replace_file(to, [&](const std::string& path) {
    Writer writer(data, work);
    core::Status done = writer.write(path);
    count = writer.count();
    return done;
  });
  fs::remove_all(work, ignored);
  if (!written) return written.error();
  return count;
}

}  // namespace hyades::coordinator
