#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::coordinator {

/// A file that grows at its end.
class LogWriter {
 public:
  virtual ~LogWriter() = default;

  /// Appends all of `bytes`. After an error any part of them may have been written.
  virtual core::Status write(std::span<const std::byte> bytes) = 0;

  /// Returns once everything written so far would survive a loss of power. After an error what was
  /// written since the last success may be lost, even if a later sync succeeds: write it again.
  virtual core::Status sync() = 0;
};

/// A file that is read at any place.
class LogReader {
 public:
  virtual ~LogReader() = default;
  /// Bytes, as of when it was opened.
  virtual uint64_t size() const = 0;
  /// Fills `into` with what stands at `offset`; an error where the file ends before.
  virtual core::Status read(uint64_t offset, std::span<std::byte> into) = 0;
  /// Why a read has failed that may succeed later; empty where none has. What a disk cannot read is
  /// damaged.
  virtual std::string passing_trouble() const { return {}; }
};

/// Exclusive use of a path, given back on destruction (or when the process dies).
class LogLock {
 public:
  virtual ~LogLock() = default;
};

/// The few file operations of the film log, so that tests can lose, tear and refuse them. A file's
/// name survives a loss of power only after sync_folder, its bytes only after LogWriter::sync.
class LogFiles {
 public:
  virtual ~LogFiles() = default;

  /// Creates the folder and its parents where they are missing.
  virtual core::Status make_folder(const std::string& folder) = 0;
  /// Makes the names of the folder's files durable.
  virtual core::Status sync_folder(const std::string& folder) = 0;

  /// The names (not paths) of the folder's files, in any order.
  virtual core::Result<std::vector<std::string>> list(const std::string& folder) = 0;

  /// A new file; an error where one is there.
  virtual core::Result<std::unique_ptr<LogWriter>> create(const std::string& path) = 0;
  /// A file that is there; an error where none is.
  virtual core::Result<std::unique_ptr<LogReader>> open(const std::string& path) = 0;

  /// Makes durable what any process wrote to the file.
  virtual core::Status sync_file(const std::string& path) = 0;

  /// Takes the place of what `to` named.
  virtual core::Status rename(const std::string& from, const std::string& to) = 0;
  /// An error where there is no such file.
  virtual core::Status remove(const std::string& path) = 0;

  /// Shortens the file, durably.
  virtual core::Status truncate(const std::string& path, uint64_t size) = 0;

  /// Refused while any process (this one too) holds it.
  virtual core::Result<std::unique_ptr<LogLock>> lock(const std::string& path) = 0;
};

/// The files of this machine.
LogFiles& disk_log_files();

}  // namespace hyades::coordinator
