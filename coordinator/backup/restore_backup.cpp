#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "coordinator/backup/backup.h"
#include "coordinator/backup/manifest.h"
#include "coordinator/job_store/incarnation_file.h"
#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

/// How many starts the lost coordinator may have had since the backup.
constexpr uint64_t kStartsBetween = 1000;
constexpr uint64_t kLongestManifest = uint64_t{1} << 30U;

using Archive = std::unique_ptr<archive, decltype(&archive_read_free)>;

core::Error torn(const std::string& from, archive* tar) {
  const char* words = tar == nullptr ? nullptr : archive_error_string(tar);
  return {from + ": the backup is torn or damaged" +
          (words != nullptr ? ": " + std::string(words) : std::string())};
}

/// Writes what the archive has of its present file, and returns what it was.
core::Result<Manifest::File> extract(archive* tar, const std::string& from, const std::string& to) {
  std::error_code failed;
  fs::create_directories(fs::path(to).parent_path(), failed);
  const core::Descriptor file(::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (failed || !file.valid()) return core::Error{to + ": " + core::io_reason(errno)};
  core::Sha256Stream digest;
  Manifest::File done;
  std::vector<std::byte> piece(size_t{1} << 18U);
  for (;;) {
    const la_ssize_t got = archive_read_data(tar, piece.data(), piece.size());
    if (got < 0) return torn(from, tar);
    if (got == 0) break;
    const auto bytes = std::span<const std::byte>(piece).first(static_cast<size_t>(got));
    digest.add(bytes);
    done.size += bytes.size();
    if (!core::write_all(file.get(), bytes)) {
      return core::Error{to + ": " + core::io_reason(errno)};
    }
  }
  if (::fsync(file.get()) != 0) return core::Error{to + ": " + core::io_reason(errno)};
  const core::Sha256 sum = digest.digest();
  done.sha256 = core::to_hex(sum);
  return done;
}

core::Result<std::string> read_manifest(archive* tar, const std::string& from, int64_t size) {
  if (size < 0 || static_cast<uint64_t>(size) > kLongestManifest) return torn(from, nullptr);
  std::string text;
  char piece[65536];
  for (;;) {
    const la_ssize_t got = archive_read_data(tar, piece, sizeof piece);
    if (got < 0) return torn(from, tar);
    if (got == 0) return text;
    text.append(piece, static_cast<size_t>(got));
  }
}

/// All files of the backup, below `folder`.
core::Result<Manifest> extract_all(const std::string& from, const std::string& folder) {
  const Archive tar(archive_read_new(), archive_read_free);
  if (!tar) return core::Error{"no memory"};
  archive_read_support_format_tar(tar.get());
  if (archive_read_open_filename(tar.get(), from.c_str(), size_t{1} << 18U) != ARCHIVE_OK) {
    return core::Error{from + ": " + archive_error_string(tar.get())};
  }
  Manifest found;
  std::optional<std::string> list;
  archive_entry* entry = nullptr;
  for (;;) {
    const int next = archive_read_next_header(tar.get(), &entry);
    if (next == ARCHIVE_EOF) break;
    // It warns of names that the locale does not know, which are bytes to us.
    if (next != ARCHIVE_OK && next != ARCHIVE_WARN) return torn(from, tar.get());
    const char* name = archive_entry_pathname(entry);
    const std::string path = name == nullptr ? "" : name;
    const bool plain =
        archive_entry_filetype(entry) == AE_IFREG && archive_entry_hardlink(entry) == nullptr;
    if (list) return core::Error{from + ": no backup of Hyades: files follow its list"};
    if (plain && path == kManifestName) {
      auto text = read_manifest(tar.get(), from, archive_entry_size(entry));
      if (!text) return text.error();
      list = std::move(*text);
      continue;
    }
    if (!plain || !is_backup_path(path) || found.files.contains(path)) {
      return core::Error{from + ": no backup of Hyades: it holds '" + path.substr(0, 200) + "'"};
    }
    auto file = extract(tar.get(), from, folder + "/" + path);
    if (!file) return file.error();
    found.files.emplace(path, *file);
  }
  if (!list) return core::Error{from + ": the backup is torn: it ends before its list of files"};
  auto manifest = parse_manifest(*list);
  if (!manifest) return manifest.error().in(from);
  for (const auto& [path, file] : manifest->files) {
    const auto there = found.files.find(path);
    if (there == found.files.end()) return core::Error{from + ": " + path + " is missing"};
    if (there->second != file) return core::Error{from + ": " + path + " is damaged"};
  }
  if (found.files.size() != manifest->files.size() || !found.files.contains("state.db")) {
    return core::Error{from + ": no backup of Hyades: its list is of other files"};
  }
  return manifest;
}

/// What a fresh file system has of its own.
constexpr const char* kLostAndFound = "lost+found";
/// Where a backup is unpacked; what a restoration that was killed has left is in nobody's way.
constexpr const char* kInWork = ".restoring-";

/// Whether the folder is there, and empty; an error where it holds anything.
core::Result<bool> is_there(const std::string& data) {
  std::error_code none;
  if (!fs::exists(fs::symlink_status(data, none))) return false;
  bool empty = fs::is_directory(data, none);
  for (fs::directory_iterator it(data, none), end; empty && !none && it != end;
       it.increment(none)) {
    const std::string name = it->path().filename().string();
    empty = name == kLostAndFound || name.starts_with(kInWork);
  }
  if (empty && !none) return true;
  return core::Error{data + ": expected a folder that is not there yet, or is empty"};
}

void remove_leftovers(const std::string& data) {
  std::vector<fs::path> left;
  std::error_code none;
  for (fs::directory_iterator it(data, none), end; !none && it != end; it.increment(none)) {
    if (it->path().filename().string().starts_with(kInWork)) left.push_back(it->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, none);
}

/// As well as can be: what is restored is there, whether or not it would outlast a loss of power.
void sync_folder(const std::string& path) { (void)core::sync_folder(path); }

void sync_all(const std::string& folder) {
  std::error_code failed;
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end;
       it.increment(failed)) {
    if (it->is_directory()) sync_folder(it->path().string());
  }
  sync_folder(folder);
}

/// Moves what is in `work` into the folder above it, which may be where a file system is mounted
/// and cannot be replaced. The job store comes last: without it the folder is no coordinator's.
core::Status move_up(const std::string& work, const std::string& data) {
  std::error_code failed;
  std::vector<std::string> names;
  for (fs::directory_iterator it(work, failed), end; !failed && it != end; it.increment(failed)) {
    names.push_back(it->path().filename().string());
  }
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return name != "state.db"; });
  for (size_t i = 0; !failed && i < names.size(); ++i) {
    if (i + 1 == names.size()) sync_folder(data);
    fs::rename(fs::path(work) / names[i], fs::path(data) / names[i], failed);
  }
  if (!failed) fs::remove(work, failed);
  if (failed) return core::Error{data + ": " + failed.message()};
  return {};
}

}  // namespace

core::Result<BackupCount> restore_backup(const std::string& from, const std::string& data) {
  const std::string target = fs::path(data).lexically_normal().string();
  const std::string wanted = target.ends_with('/') ? target.substr(0, target.size() - 1) : target;
  const auto there = is_there(wanted);
  if (!there) return there.error();
  const std::string name = kInWork + std::to_string(::getpid());
  const std::string work = *there ? wanted + "/" + name : wanted + name;
  std::error_code failed;
  fs::create_directories(fs::path(work).parent_path(), failed);
  if (*there) remove_leftovers(wanted);
  if (::mkdir(work.c_str(), 0700) != 0) {
    return core::Error{work + ": cannot be made: " + core::io_reason(errno)};
  }
  const auto give_up = [&](const core::Error& error) {
    std::error_code ignored;
    fs::remove_all(work, ignored);
    return error;
  };
  const auto manifest = extract_all(from, work);
  if (!manifest) return give_up(manifest.error());
  const std::string starts = work + "/state.db.starts";
  auto counted = count_start(starts, 0);
  if (counted) counted = count_start(starts, *counted + kStartsBetween);
  if (!counted) return give_up(counted.error());
  sync_all(work);
  if (*there) {
    if (auto moved = move_up(work, wanted); !moved) return moved.error();
    sync_folder(wanted);
  } else {
    fs::rename(work, wanted, failed);
    if (failed) return give_up({wanted + ": " + failed.message()});
  }
  sync_folder(fs::absolute(wanted).parent_path().string());
  BackupCount count;
  for (const auto& [path, file] : manifest->files) count.bytes += file.size;
  count.files = manifest->files.size();
  return count;
}

}  // namespace hyades::coordinator
