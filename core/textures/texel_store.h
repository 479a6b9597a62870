#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::core {

/// Where texels are kept: in memory within a budget, and beyond it in files without a name, mapped
/// into memory, whose pages the system reads when they are looked at and drops when there is no
/// room for them. Looking up a texel is the same either way, and so are its bits. Thread-safe; what
/// it gave out may outlive it.
class TexelStore {
 public:
  /// `budget` bytes of memory; the files' folder (where it is empty, that of temporary files,
  /// TMPDIR or /tmp), which should not be one in memory.
  explicit TexelStore(uint64_t budget = default_budget(), std::string folder = {});

  /// With one file for all that is kept in files, open to read and write and used by nobody else,
  /// instead of a folder: for a process that may open none later, and that reads what strangers
  /// wrote. The file gets no longer than `most` bytes, and takes no more of its disk than it leaves
  /// to others. Nothing is kept in a file that is none.
  TexelStore(uint64_t budget, Descriptor file, uint64_t most);

  /// A file without a name in the folder, to read and write.
  static Result<Descriptor> open_file(const std::string& folder);

  /// A quarter of the memory that this process may take; without bound where that is not known.
  static uint64_t default_budget();

  /// Half of what is free on the disk that the file lies on; 0 where that cannot be told.
  static uint64_t half_of_free(const Descriptor& file);

  /// Keeps `bytes`. Those of a few pages stay in memory in any case. Errors: the budget is used up,
  /// and the file cannot be written, or would get too long.
  Result<Bytes> keep(std::vector<std::byte> bytes);

  uint64_t in_memory() const { return used_->load(); }

 private:
  struct Place;
  class CommonFile;
  Result<Bytes> keep_in_file(const std::vector<std::byte>& bytes) const;
  Result<Place> place_for(size_t size) const;

  const uint64_t budget_;
  const std::string folder_;
  const std::shared_ptr<CommonFile> common_;  ///< null: a file of its own for all that is kept
  const std::shared_ptr<std::atomic<uint64_t>> used_;  ///< bytes, also of what outlives the store
};

}  // namespace hyades::core
