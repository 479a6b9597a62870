#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/result.h"

namespace hyades::farm {

class ContentStore;

/// A file of a ContentStore in the making. Destroyed without commit(), it leaves what it has for a
/// later writer to go on with. One thread at a time.
class ContentWriter {
 public:
  ContentWriter(ContentWriter&&) noexcept;
  ContentWriter& operator=(ContentWriter&&) = delete;
  ~ContentWriter();

  /// Bytes that are there: what comes next begins here.
  uint64_t offset() const { return offset_; }
  uint64_t size() const { return size_; }
  /// The SHA-256 that the whole file has to have.
  const std::string& name() const { return name_; }

  /// Errors: more bytes than the file's size, a full disk.
  core::Status append(std::span<const std::byte> bytes);

  /// Gives the complete file its name, durably. Where bytes are missing nothing changes; where the
  /// bytes are not those that the name promises they are thrown away, and both are errors.
  core::Status commit();

 private:
  friend class ContentStore;
  ContentWriter(ContentStore& store, std::string name, uint64_t size)
      : store_(&store), name_(std::move(name)), size_(size) {}

  /// Takes hold of the unfinished file `begun`, or, where someone else writes to it, of a new one.
  core::Status take_partial(const std::string& begun);
  /// Reads what it has and does not know; `busy` as for ContentStore::read().
  core::Status read_partial(bool* busy);
  /// So many bytes more are there: they are not expected any more.
  void go_on(uint64_t bytes);
  /// The unfinished file is not written any more.
  void stop_counting();

  ContentStore* store_;
  std::string name_;
  uint64_t size_ = 0;
  uint64_t offset_ = 0;
  std::string path_;       ///< of the unfinished file
  bool resumable_ = true;  ///< whether a later writer will find it
  bool counted_ = false;   ///< among ContentStore::writing_
  core::Descriptor file_;  ///< locked exclusively
  core::Sha256Stream hash_;
  std::shared_ptr<std::atomic<uint64_t>> expected_;  ///< the owner's, in ContentStore
};

}  // namespace hyades::farm
