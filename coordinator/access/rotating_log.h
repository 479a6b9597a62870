#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Lines that are only ever added to, in a row of files that only their owner may read:
/// NAME.jsonl, NAME.1.jsonl (older), ... The oldest goes. write() by one thread at a time;
/// for_reading() by any.
class RotatingLog {
 public:
  struct Options {
    std::string folder;
    std::string name;
    uint64_t most_bytes = 0;  ///< of a file; then the next one is begun
    int most_files = 1;
  };
  explicit RotatingLog(Options options) : options_(std::move(options)) {}

  /// Opens the newest, or makes it; a line that a crash has cut is ended. An error that names it
  /// where it cannot be written to.
  core::Status open();

  /// Adds lines, each with its end, and has them on the disk. False where that fails: none of them
  /// counts then, and those that were written are taken away again as far as the disk allows. The
  /// next call opens the file again.
  bool write(const std::string& lines);

  /// The last line that there is, without its end; empty where there is none.
  std::string last_line() const;

  const std::string& name() const { return options_.name; }

  /// What there is at this moment, the newest first.
  std::vector<core::Descriptor> for_reading() const;

 private:
  std::string path(int number) const;
  void rotate();

  const Options options_;
  core::Descriptor file_;
  uint64_t size_ = 0;
  mutable core::Mutex naming_;  ///< held while files get other names, or are looked for by them
};

}  // namespace hyades::coordinator
