#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "coordinator/film_store/film_records.h"
#include "coordinator/film_store/films_aside.h"
#include "coordinator/film_store/log_files.h"
#include "coordinator/scheduler/actions.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::coordinator {

/// The films that a store is for.
struct FilmSet {
  std::vector<int32_t> frames;
  core::PixelRect region;  ///< of every frame
  uint32_t samples = 1;    ///< per pixel, of the whole job
  bool judged = false;     ///< its tiles are judged: see LogFilter
  bool splats = false;     ///< the films have some
};

/// What became of a frame that is over.
enum class FrameEnd : uint8_t {
  finished,
  failed,
  unwritten,  ///< its film is complete, but its outputs could not be written
};

/// What becomes of films that an earlier run has kept.
enum class KeptFilms : uint8_t {
  erase,  ///< they go
  use,    ///< they are gone on with; where they are of other pictures, those of finished frames go,
          ///< and where a frame is not finished, nothing begins
  require,  ///< they are gone on with; where they are of other pictures, nothing begins
};

/// Where and how a store keeps its films.
struct FilmStoreOptions {
  std::string folder;  ///< empty: nothing is kept, the run cannot be resumed
  /// Hash of what decides a frame's pixels: a kept film of another key is never mixed in. Called by
  /// many threads. All frames have the same key where it is empty.
  std::function<FrameKey(int32_t frame)> frame_key;
  KeptFilms kept = KeptFilms::erase;  ///< what the folder holds
  /// Films that it holds are set aside from the start: none is in memory before it is fetched.
  bool kept_aside = false;
  /// Films that may wait for the disk before those who hand them over wait too.
  uint64_t max_waiting_bytes = uint64_t{512} << 20U;
  /// The log is rewritten when it has grown by this much, and by as much as the films take.
  uint64_t compact_bytes = 256'000'000;
  /// The store gives up when nothing could be stored for this long.
  Duration patience = std::chrono::seconds(30);
  LogFiles* files = nullptr;  ///< the disk where null
  /// A folder of this machine's disk for films that leave memory; empty: `folder`, among `files`.
  std::string aside_folder;
  /// Held while a record of all of a film is in memory beside that film, or without it: where
  /// films have splats. So all stores that share it have one at a time. None where null.
  core::Mutex* whole_records = nullptr;
  /// Called by the log's thread: so long took the disk to make a group of films durable.
  std::function<void(std::chrono::nanoseconds took)> on_sync{};
};

/// Makes films durable and merges them: a write-ahead log and the films in memory. It works on a
/// thread of its own, so that render threads never wait for the disk: they hand films over and go
/// on. Films are merged in memory only once they are durable.
class FilmStore {
 public:
  /// Whom the store's thread reports to.
  class Listener {
   public:
    virtual ~Listener() = default;
    /// The record is durable. Its film may be merged during this call.
    virtual void persisted(RecordId record) = 0;
    /// The record could not be taken; the film of a unit is lost.
    virtual void not_persisted(RecordId record, const std::string& reason) = 0;
    /// By merge(): the frame's film would take more memory than it may, or by fetch(): it cannot be
    /// read again. It holds nothing any more, and the frame is to fail.
    virtual void outgrown(int32_t frame, const std::string& reason) = 0;
    /// Some time after not_persisted: it may be tried again.
    virtual void try_again() = 0;
    /// Nothing could be stored for too long.
    virtual void storage_failed(const std::string& reason) = 0;
    /// All that was handed over is durable or lost, and the thread ends.
    virtual void drained() = 0;
  };

  FilmStore(FilmSet films, FilmStoreOptions options, Listener& listener);
  ~FilmStore();

  /// Opens the log, if there is to be one, and returns what it holds of the frames it is for.
  core::Result<LogContents> open();
  /// The frame's outputs are gone: it will be rendered again. Before start().
  void reopen(int32_t frame) {
    own_thread_.assert_held();
    finished_.erase(frame);
  }
  /// Begins to store what is handed over. `tile_size` [pixels]: how the films' frames are cut.
  core::Status start(int32_t tile_size);
  /// Waits for the end of the thread; somebody has called drain().
  void join();

  // Any thread, and before open() already: what is handed over then waits.

  /// Takes what is to be durable; never waits. `film` and `packed` (encode_delivered) belong to the
  /// unit that a worker has delivered, where the record is one.
  void append(RecordId id, Record record, core::Film film = {}, std::vector<std::byte> packed = {});
  /// Takes a unit that the calling thread has rendered, and packs its film. Waits while too much
  /// waits for the disk already.
  void append_rendered(RecordId id, const UnitRecord& unit, core::Film film);
  /// From now on append_rendered() does not wait any more.
  void hurry();
  /// No more will come: the thread makes durable what it has, and ends.
  void drain();
  /// Why nothing can be stored at the moment; empty where it can.
  std::string trouble() const;
  /// As much waits for the disk as may: who delivers should come again later.
  bool crowded() const;
  /// The disk is short: the log is rewritten soon, if that frees something.
  void make_room();
  /// Has the store's thread call `what` soon.
  void call(std::function<void()> what);

  // The store's thread (from within Listener's functions), or before start().

  /// Adds the film that was handed over as `record` and is durable now.
  core::Status merge(RecordId record);
  /// What has been merged of the frame; null where nothing has.
  std::shared_ptr<const core::Film> film(int32_t frame) const;
  /// The frame's film leaves memory, for a file of this run beside the log, and comes back with
  /// fetch(), or when something is merged with it. On an error it stays in memory.
  core::Status set_aside(int32_t frame);
  /// Whether the frame's film is set aside.
  bool is_aside(int32_t frame) const {
    own_thread_.assert_held();
    return aside_.contains(frame);
  }
  /// A copy of the frame's film, which is set aside and stays so; null where it holds nothing.
  core::Result<std::shared_ptr<core::Film>> read_aside(int32_t frame) const {
    own_thread_.assert_held();
    return aside_.read(frame);
  }
  /// Has the frame's film in memory, if there is one. Whether that could be done: where it cannot
  /// be read it is tried again, for as long as FilmStoreOptions::patience.
  bool fetch(int32_t frame);
  /// The frame is over. A film whose outputs could not be written stays in the log for another run.
  void forget(int32_t frame, FrameEnd end);

 private:
  struct Item {
    RecordId id{};
    Record record;
    core::Film film;               ///< of a unit
    std::vector<std::byte> bytes;  ///< of the log; none where the record is not the log's
    std::function<void()> call;    ///< instead of a record
    uint64_t memory = 0;
    uint64_t sequence = 0;
  };

  using Places = std::map<int32_t, std::vector<RecordPlace>>;

  /// Whether there is, or will be, a log.
  bool logs() const { return !options_.folder.empty(); }
  core::Status open_log(bool erase) HYADES_REQUIRES(own_thread_);
  FrameKey key_of(int32_t frame) const;
  std::vector<std::byte> encoded(const Record& record) const;
  void push(Item item, bool may_wait);
  void run();
  bool has_work() const HYADES_REQUIRES(mutex_, own_thread_);
  void wait_for_work() HYADES_REQUIRES(mutex_, own_thread_);
  void append(std::deque<Item> items) HYADES_REQUIRES(own_thread_);
  void settle(uint64_t durable) HYADES_REQUIRES(own_thread_);
  void apply(const Record& record) HYADES_REQUIRES(own_thread_);
  void compact_if_worthwhile(bool room_wanted) HYADES_REQUIRES(own_thread_);
  core::Status write_snapshot(const FilmLog::Sink& sink, Places& places)
      HYADES_REQUIRES(own_thread_);
  void release(uint64_t memory);
  LogFiles& files() const;
  LogFiles& aside_files() const;
  std::string aside_folder() const;
  core::Status copy_aside(int32_t frame, const FilmLog::Sink& sink, Places& places)
      HYADES_REQUIRES(own_thread_);
  core::Status put_film(int32_t frame, const core::Film& film, const FilmLog::Sink& sink)
      HYADES_REQUIRES(own_thread_);
  core::Status count(int32_t frame, std::span<const std::byte> record, const FilmLog::Sink& sink)
      HYADES_REQUIRES(own_thread_);
  std::unique_lock<core::Mutex> hold_whole_records() const;
  void set_unfinished_aside() HYADES_REQUIRES(own_thread_);
  bool wait_to_read(TimePoint end);
  std::string class_of(int32_t frame) const HYADES_REQUIRES(own_thread_);

  const FilmSet set_;
  const FilmStoreOptions options_;
  Listener& listener_;

  /// Shared with those who hand over and with the log's commit thread.
  mutable core::Mutex mutex_;
  core::CondVar wake_;  ///< for the store's thread
  core::CondVar room_;  ///< for those who hand over
  std::deque<Item> queue_ HYADES_GUARDED_BY(mutex_);
  uint64_t waiting_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  uint64_t durable_ HYADES_GUARDED_BY(mutex_) = 0;
  bool hurrying_ HYADES_GUARDED_BY(mutex_) = false;
  bool draining_ HYADES_GUARDED_BY(mutex_) = false;
  bool room_wanted_ HYADES_GUARDED_BY(mutex_) = false;
  std::string trouble_ HYADES_GUARDED_BY(mutex_);
  TimePoint trouble_since_ HYADES_GUARDED_BY(mutex_);

  /// The store's thread, and who opens and starts it.
  core::ThreadRole own_thread_;
  std::deque<Item> appended_ HYADES_GUARDED_BY(own_thread_);  ///< not durable yet, or not settled
  Item* settling_ HYADES_GUARDED_BY(own_thread_) = nullptr;
  std::map<int32_t, std::shared_ptr<core::Film>> films_ HYADES_GUARDED_BY(own_thread_);
  FilmsAside aside_
      HYADES_GUARDED_BY(own_thread_);  ///< films that are set aside, and so not in films_
  std::map<int32_t, std::string> classes_
      HYADES_GUARDED_BY(own_thread_);  ///< of frames, where workers delivered their films
  std::map<int32_t, FinishedRecord> finished_ HYADES_GUARDED_BY(own_thread_);
  /// Complete films of frames whose outputs could not be written; null where they are set aside.
  std::map<int32_t, std::shared_ptr<core::Film>> unfinished_ HYADES_GUARDED_BY(own_thread_);
  bool unfinished_anew_ HYADES_GUARDED_BY(own_thread_) = false;  ///< one of them may be set aside
  int32_t tile_size_ HYADES_GUARDED_BY(own_thread_) = 0;
  bool disputed_ HYADES_GUARDED_BY(own_thread_) = false;   ///< films may be wrong
  bool write_cut_ HYADES_GUARDED_BY(own_thread_) = false;  ///< the log is new
  uint64_t settled_sequence_ HYADES_GUARDED_BY(own_thread_) = 0;
  uint64_t log_bytes_ HYADES_GUARDED_BY(own_thread_) = 0;       ///< since the last snapshot
  uint64_t snapshot_bytes_ HYADES_GUARDED_BY(own_thread_) = 0;  ///< of the last snapshot
  uint64_t useless_bytes_ HYADES_GUARDED_BY(own_thread_) =
      0;  ///< in the log, of frames that are over
  std::map<int32_t, uint64_t> frame_bytes_
      HYADES_GUARDED_BY(own_thread_);                       ///< in the log, of frames that are not
  TimePoint compact_again_ HYADES_GUARDED_BY(own_thread_);  ///< after a failure
  bool others_films_ HYADES_GUARDED_BY(own_thread_) =
      false;  ///< the log has films of frames that nobody asked for
  std::optional<TimePoint> try_again_at_ HYADES_GUARDED_BY(own_thread_);
  bool gave_up_ HYADES_GUARDED_BY(own_thread_) =
      false;  ///< the listener knows of the trouble that there is

  std::unique_ptr<FilmLog> log_;
  std::thread thread_;
};

}  // namespace hyades::coordinator
