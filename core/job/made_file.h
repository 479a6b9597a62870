#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"

namespace hyades::core {

/// A file in a folder that finishers and encoders may write to. What they open runs in them, and
/// may put a link in the file's place or cut it off at any time: so it is never mapped. It is open
/// only while it is read, since many may wait to be read on.
class MadeFile {
 public:
  /// Finds the regular file `path` below `folder`; neither it nor a folder on the way to it, below
  /// `folder`, may be a link. Errors do not repeat the name.
  static Result<MadeFile> find(const std::string& folder, const std::string& path);

  MadeFile() = default;

  /// Bytes that it had when it was found.
  uint64_t size() const { return size_; }
  /// Reads all of `into` from `offset` on; false where it is gone, another file is in its place, or
  /// it is not as long any more.
  bool read(uint64_t offset, std::span<std::byte> into) const;
  /// Reads it whole; an error where it has more bytes than `most`.
  Result<Bytes> read_whole(uint64_t most) const;

 private:
  std::string folder_;
  std::string path_;
  uint64_t size_ = 0;
  dev_t device_ = 0;
  ino_t number_ = 0;
};

/// Removes the folder `path` below `folder`, with all that is in it, if no link leads to it. What
/// cannot be removed stays.
void remove_made_folder(const std::string& folder, const std::string& path);

}  // namespace hyades::core
