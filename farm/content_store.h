#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/content_writer.h"

namespace hyades::farm {

/// Whether `name` is the lower-case hexadecimal SHA-256 of something: the only names that the
/// store turns into paths.
bool is_content_name(std::string_view name);

/// Keeps one file of a store from eviction, by any process, until it is destroyed (also by the end
/// of this process, however that comes).
class ContentPin {
 public:
  explicit ContentPin(core::Descriptor locked) : locked_(std::move(locked)) {}

 private:
  core::Descriptor locked_;
};

/// What somebody has of files that are not whole.
struct UnfinishedFiles {
  uint64_t files = 0;
  uint64_t bytes = 0;  ///< of those that are being written all that they will have
};

/// For whom a file is written.
struct Uploader {
  /// Each owner has unfinished files of his own: what one writes spoils no other's.
  std::string owner{};
  /// Whether he may have one more beside those that he has; none: he may. Asked more than once, of
  /// which the last answer counts, and must not use the store.
  std::function<core::Status(const UnfinishedFiles& others)> may_begin{};
  /// Where not null, nobody waits: see ContentStore::read().
  bool* busy = nullptr;
};

/// Files named by the SHA-256 of their bytes, in one folder. A file has its name only once all its
/// bytes were checked against it and are durable; what is damaged later (truncated, corrupted) is
/// noticed when it is read, removed and then simply missing, so that it is fetched again.
///
/// Thread-safe. Several processes may share a folder. Bytes that were read stay valid when their
/// file is evicted.
///
/// What all files take is not asked of the disk for each that is written: processes count in the
/// folder's lock file the bytes that they have begun with, and what was found at the last listing
/// with those that all have begun since is the most that there can be. The folder is listed again
/// where that is too much, and every few seconds, for what nobody has counted (files that somebody
/// put there, and what others had still to write of theirs at the last listing).
class ContentStore {
 public:
  struct Options {
    std::string folder;   ///< made if it is missing; its parent must exist
    uint64_t budget = 0;  ///< bytes of all files, unfinished ones included; 0: no limit, and
                          ///< nothing is ever evicted
    /// For a lock that another process has; whoever may read a file may lock it for ever.
    std::chrono::milliseconds lock_patience{5000};
    /// How old the total of all files may be that the budget is held against.
    std::chrono::milliseconds list_every{10'000};
  };

  static core::Result<std::unique_ptr<ContentStore>> open(const Options& options);

  /// Whether there is a file `name`. One that has not `size` bytes is checked first, so that a
  /// truncated file counts as missing. `busy` as for read().
  bool contains(const std::string& name, uint64_t size, bool* busy = nullptr);

  /// Whether there is surely no file `name`; one that cannot be looked at now may be there.
  bool missing(const std::string& name) const;

  /// The bytes of file `name`, mapped. They are hashed when this process first reads the file and
  /// whenever the file changed since. Errors: no such file, damaged (it is removed, where this
  /// process may), unreadable.
  /// One thread hashes a file, and others that want it wait. Who gives `busy` does not, as long as
  /// large files take: where somebody hashes it, or as many as may hash large ones, that becomes
  /// true, and it is an error, for now.
  core::Result<core::Bytes> read(const std::string& name, bool* busy = nullptr);

  /// The names of files that read() found damaged since the last call.
  std::set<std::string> take_damaged();

  /// Hashes file `name` also where this process knows it; a damaged one is removed.
  void check_again(const std::string& name);

  /// Counts as use of the file, for eviction. Error where there is no such file, or where another
  /// process has locked it for itself and does not let go.
  core::Result<ContentPin> pin(const std::string& name);

  /// Begins or resumes file `name` of `size` bytes: the writer's offset says what is there already
  /// of the same owner's. Of two that write the same file at once for one owner the second begins
  /// its own copy; the first that is whole and right becomes the file. With a budget, files that
  /// were not used for longest make room, and some for later files; it is an error if those that
  /// are not pinned are too few.
  /// Where `whose` has as many unfinished files as he may, those of his that rest for longest (a
  /// minute at least) make room. The store must outlive the writer.
  /// `crowded` becomes whether the budget has no room for it, which is no fault of the disk.
  core::Result<ContentWriter> write(const std::string& name, uint64_t size,
                                    const Uploader& whose = {}, bool* crowded = nullptr);

  /// How many bytes of file `name` an unfinished write of this owner's has left: where write() will
  /// probably go on. Makes nothing and reads nothing, so that answering anybody's question costs
  /// little.
  uint64_t begun(const std::string& name, const std::string& owner = {}) const;

  /// Removes file `name`, pinned or not. No error where it is missing.
  core::Status remove(const std::string& name);

  /// The names of all complete files.
  std::vector<std::string> names() const;
  /// Bytes of all complete files; looks at each of them.
  uint64_t used() const;
  /// Removes unfinished files that nobody writes, those that rest for longest first, until `bytes`
  /// are free. One that got a byte within the last minute stays: it may be between two pieces. How
  /// many bytes that were.
  uint64_t free_partials(uint64_t bytes);
  /// How many files this process knows to be what their names promise.
  size_t known() const;
  /// How many files this process has completed so far.
  uint64_t commits() const { return commits_; }
  /// Bytes that this process' writers have still to write.
  uint64_t expected() const { return expected_; }
  /// Those of each owner who has any.
  std::map<std::string, uint64_t> expected_of_owners() const;
  /// Notes that the file has been of use now: who removes what is not used waits again.
  void touch(const std::string& name) const;
  /// Removes file `name` if it was neither written, read nor touched within `age`, by the wall
  /// clock. Whether it is gone.
  bool remove_unused(const std::string& name, std::chrono::nanoseconds age);

 private:
  friend class ContentWriter;

  /// What tells one state of a file from another without reading it.
  struct Identity {
    uint64_t inode = 0;
    uint64_t size = 0;
    int64_t modified = 0;  ///< nanoseconds
    bool operator==(const Identity&) const = default;
  };

  explicit ContentStore(const Options& options) : options_(options) {}
  std::string path_of(const std::string& name) const { return options_.folder + "/" + name; }
  /// Where the owner's unfinished file lies.
  std::string partial_path(const std::string& name, const std::string& owner) const;
  static core::Result<Identity> identify(const std::string& path);
  void remember(const std::string& name, const Identity& identity);
  void forget(const std::string& name);
  /// A turn to hash a file; see read().
  class Hashing {
   public:
    /// Of the file at `path`. Waits; where `busy` is given and the file is large, that becomes true
    /// instead.
    Hashing(ContentStore& store, std::string path, uint64_t bytes, bool* busy);
    ~Hashing();
    Hashing(const Hashing&) = delete;
    Hashing& operator=(const Hashing&) = delete;
    /// Whether it is this one's turn.
    bool begun() const { return begun_; }

   private:
    bool begin() HYADES_REQUIRES(store_.mutex_);

    ContentStore& store_;
    const std::string path_;
    const bool large_;
    bool begun_ = false;
  };
  /// Takes over what is known of the unfinished file that the writer has taken; see kept_.
  void take_kept(ContentWriter& writer);
  /// Keeps what the writer knows of the unfinished file that it leaves.
  void keep(ContentWriter& writer);
  /// Evicts until `bytes` more fit, of which there are some in the unfinished file `begun` (empty:
  /// none).
  core::Status make_room(const std::string& begun, uint64_t bytes, bool* crowded = nullptr);
  uint64_t evict(const std::string& begun, uint64_t used);
  void sweep_partials();
  /// Whether the uploader may have the unfinished file at `path` beside his others, some of which
  /// may have to go.
  core::Status admit(const Uploader& whose, const std::string& path)
      HYADES_REQUIRES(partials_mutex_);
  /// Removes what all owners have of file `name`, which is whole, but for those who write it.
  void drop_partials(const std::string& name);
  core::Status commit(ContentWriter& writer);
  /// Counts what the writer has still to write as expected, of this owner.
  void expect(ContentWriter& writer, const std::string& owner);

  Options options_;
  std::atomic<uint64_t> expected_{0};  ///< bytes that this process' writers have still to write
  mutable core::Mutex owners_mutex_;
  /// Of expected_ each owner's part, which his writers count down.
  std::map<std::string, std::shared_ptr<std::atomic<uint64_t>>> expected_of_
      HYADES_GUARDED_BY(owners_mutex_);
  std::atomic<int64_t> next_sweep_{0};  ///< seconds of the steady clock
  std::atomic<uint64_t> commits_{0};
  /// What all files take.
  struct Total {
    uint64_t bytes = 0;  ///< at most: what was found, and what processes have begun with since
    uint64_t begun = 0;  ///< the folder's count of the latter, when it was looked at last
    std::chrono::steady_clock::time_point listed;
  };
  core::Mutex room_mutex_;
  std::optional<Total> total_ HYADES_GUARDED_BY(room_mutex_);
  core::Mutex partials_mutex_;
  /// Unfinished files that this process writes, by their path, and how large they will be.
  std::map<std::string, uint64_t> writing_ HYADES_GUARDED_BY(partials_mutex_);
  /// How far the hash of an unfinished file has come that nobody writes now, so that whoever goes
  /// on with it does not read all of it again. Of large ones, by their path.
  struct Kept {
    Identity identity;
    core::Sha256Stream hash;
  };
  std::map<std::string, Kept> kept_ HYADES_GUARDED_BY(partials_mutex_);
  mutable core::Mutex mutex_;
  core::CondVar hashed_;
  std::set<std::string> hashing_ HYADES_GUARDED_BY(mutex_);  ///< paths
  size_t large_hashing_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<std::string, Identity> verified_ HYADES_GUARDED_BY(mutex_);
  std::set<std::string> damaged_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::farm
