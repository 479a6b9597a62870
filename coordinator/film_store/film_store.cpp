#include "coordinator/film_store/film_store.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <span>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/base/failpoint.h"
#include "core/base/overloaded.h"
#include "core/base/parallel.h"
#include "core/film/film_codec.h"

namespace hyades::coordinator {
namespace {

/// After something could not be taken: when the scheduler hands out work again.
constexpr Duration kTryAgain = std::chrono::milliseconds(1100);

/// While a film that is set aside cannot be read.
constexpr Duration kReadAgain = std::chrono::milliseconds(50);

/// How many complete films whose outputs could not be written are kept for another run. They may
/// cost memory; more would have to be rendered again.
constexpr size_t kUnfinishedFilms = 2;

/// Whose log it is. What its films are of stands beside each of them.
constexpr const char* kLogKey = "hyades render, films by frame";

TimePoint now() { return std::chrono::steady_clock::now(); }

}  // namespace

FilmStore::FilmStore(FilmSet films, FilmStoreOptions options, Listener& listener)
    : set_(std::move(films)),
      options_(std::move(options)),
      listener_(listener),
      aside_(aside_files(), aside_folder(), set_.region) {}

FilmStore::~FilmStore() {
  drain();
  join();
  // Where it was never started somebody may wait still.
  std::deque<Item> left;
  {
    const core::MutexLock lock(mutex_);
    left.swap(queue_);
  }
  for (const Item& item : left) {
    if (item.call) item.call();
  }
  // The log has all of them.
  aside_.remove_all();
  log_.reset();
}

void FilmStore::join() {
  if (thread_.joinable()) thread_.join();
}

FrameKey FilmStore::key_of(int32_t frame) const {
  return options_.frame_key ? options_.frame_key(frame) : FrameKey{};
}

core::Status FilmStore::open_log(bool erase) {
  log_.reset();
  LogFiles& files = this->files();
  if (core::Status made = files.make_folder(options_.folder); !made) return made;
  if (erase) {
    if (core::Status erased = erase_film_log(options_.folder, &files); !erased) return erased;
  }
  FilmLogOptions options;
  options.files = &files;
  options.on_sync = options_.on_sync;
  options.on_durable = [this](uint64_t through) {
    const core::MutexLock lock(mutex_);
    durable_ = std::max(durable_, through);
    trouble_.clear();
    wake_.notify_one();
  };
  options.on_trouble = [this](const core::Error& error) {
    const core::MutexLock lock(mutex_);
    if (trouble_.empty()) trouble_since_ = now();
    trouble_ = error.message;
    room_wanted_ = true;  // mostly it is the disk that is full
    wake_.notify_one();
  };
  auto log = FilmLog::open(options_.folder, kLogKey, options);
  if (!log) return log.error();
  log_ = std::move(*log);
  // All that an earlier run had set aside is in the log.
  if (core::Status made = aside_files().make_folder(aside_folder()); !made) return made;
  return aside_.remove_left();
}

LogFiles& FilmStore::files() const {
  return options_.files != nullptr ? *options_.files : disk_log_files();
}

LogFiles& FilmStore::aside_files() const {
  return options_.aside_folder.empty() ? files() : disk_log_files();
}

std::string FilmStore::aside_folder() const {
  return options_.aside_folder.empty() ? options_.folder : options_.aside_folder;
}

core::Result<LogContents> FilmStore::open() {
  own_thread_.assert_held();
  if (options_.folder.empty()) return LogContents{};
  const bool erase = options_.kept == KeptFilms::erase;
  if (core::Status opened = open_log(erase); !opened) return opened.error();
  const LogFilter filter{{set_.frames.begin(), set_.frames.end()},
                         set_.region,
                         set_.samples,
                         options_.frame_key,
                         set_.judged,
                         options_.kept_aside};
  const auto alone = hold_whole_records();
  auto contents = read_log(*log_, filter);
  if (!contents) return contents.error().in(options_.folder);
  std::string useless = contents->other_picture;
  if (!useless.empty() && options_.kept == KeptFilms::require) {
    return core::Error{useless}.in(options_.folder);
  }
  if (!useless.empty() && contents->unfinished) {
    return core::Error{useless + ": --restart gives them up, another --output leaves them"}.in(
        options_.folder);
  }
  if (!contents->empty && contents->cut.tile_size == 0) {
    // Its beginning is damaged: without the cut the films cannot be told apart into units.
    useless = "how the frames were cut is lost";
  }
  if (!useless.empty()) {
    if (core::Status opened = open_log(true); !opened) return opened.error();
    auto problems = std::move(contents->problems);
    contents = read_log(*log_, filter);
    if (!contents) return contents.error().in(options_.folder);
    problems.push_back(useless + ": it begins afresh");
    contents->problems = std::move(problems);
  }
  finished_ = contents->finished;
  films_ = contents->films;
  for (const auto& [frame, places] : contents->places) aside_.leave(*log_, frame, places);
  disputed_ = contents->disputed;
  // What of it is of use is not known until it is rewritten.
  useless_bytes_ = contents->bytes;
  settled_sequence_ = log_->durable();
  others_films_ = contents->others;
  for (const auto& [frame, units] : contents->units) classes_[frame] = units.front().worker_class;
  write_cut_ = contents->empty || contents->cut.region != set_.region;
  tile_size_ = contents->cut.tile_size;
  return contents;
}

core::Status FilmStore::start(int32_t tile_size) {
  own_thread_.assert_held();
  tile_size_ = tile_size;
  if (log_ && write_cut_) {
    auto written = log_->append(encode_cut({set_.region, tile_size, set_.samples}));
    if (!written) return written.error();
  }
  auto thread = core::start_thread([this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(*thread);
  return {};
}

void FilmStore::push(Item item, bool may_wait) {
  const core::MutexLock lock(mutex_);
  while (may_wait && !hurrying_ && waiting_bytes_ >= options_.max_waiting_bytes) {
    room_.wait(mutex_);
  }
  waiting_bytes_ += item.memory;
  queue_.push_back(std::move(item));
  wake_.notify_one();
}

/// What the log holds of a record whose film is none. A failed frame and a divergent worker are
/// rows of the job store: here they only come after what was handed over before.
std::vector<std::byte> FilmStore::encoded(const Record& record) const {
  if (!logs()) return {};
  using Bytes = std::vector<std::byte>;
  return std::visit(core::Overloaded{
                        [](const UnitRecord&) { return Bytes(); },
                        [&](const FrameFinishedRecord& done) {
                          return encode_finished(done.frame, {key_of(done.frame), set_.region});
                        },
                        [](const FrameFailedRecord&) { return Bytes(); },
                        [](const FrameRestartedRecord& restarted) { return encode(restarted); },
                        [](const TileVoidedRecord& voided) { return encode(voided); },
                        [](const DisputeRecord& dispute) { return encode(dispute); },
                        [](const DivergentWorkerRecord&) { return Bytes(); },
                    },
                    record);
}

void FilmStore::append(RecordId id, Record record, core::Film film, std::vector<std::byte> packed) {
  Item item;
  item.id = id;
  item.bytes = encoded(record);
  item.record = std::move(record);
  if (std::holds_alternative<UnitRecord>(item.record)) {
    if (logs()) item.bytes = std::move(packed);
    item.memory = film.memory() + item.bytes.size();
    item.film = std::move(film);
  }
  push(std::move(item), false);
}

void FilmStore::append_rendered(RecordId id, const UnitRecord& unit, core::Film film) {
  Item item;
  item.id = id;
  item.record = unit;
  // Packing takes longer than anything else here and so is done by the thread that hands over.
  const int32_t frame = unit.accepted.unit.frame;
  if (logs()) item.bytes = encode_unit(frame, key_of(frame), film);
  item.memory = film.memory() + item.bytes.size();
  item.film = std::move(film);
  push(std::move(item), true);
}

void FilmStore::call(std::function<void()> what) {
  Item item;
  item.call = std::move(what);
  push(std::move(item), false);
}

void FilmStore::make_room() {
  const core::MutexLock lock(mutex_);
  room_wanted_ = true;
  wake_.notify_one();
}

bool FilmStore::crowded() const {
  const core::MutexLock lock(mutex_);
  return waiting_bytes_ >= options_.max_waiting_bytes;
}

void FilmStore::hurry() {
  const core::MutexLock lock(mutex_);
  hurrying_ = true;
  room_.notify_all();
}

void FilmStore::drain() {
  const core::MutexLock lock(mutex_);
  hurrying_ = true;
  draining_ = true;
  wake_.notify_one();
  room_.notify_all();
}

std::string FilmStore::trouble() const {
  const core::MutexLock lock(mutex_);
  return trouble_;
}

bool FilmStore::has_work() const {
  return !queue_.empty() || draining_ || room_wanted_ ||
         (!appended_.empty() && appended_.front().sequence <= durable_);
}

void FilmStore::wait_for_work() {
  std::optional<TimePoint> until = try_again_at_;
  if (!trouble_.empty() && !gave_up_) {
    const TimePoint end = trouble_since_ + options_.patience;
    until = until ? std::min(*until, end) : end;
  }
  while (!has_work()) {
    if (!until) {
      if (!trouble_.empty() && !gave_up_) return;
      wake_.wait(mutex_);
    } else if (now() >= *until) {
      return;
    } else {
      wake_.wait_until(mutex_, *until);
    }
  }
}

void FilmStore::run() {
  own_thread_.assert_held();
  for (;;) {
    core::MutexLock lock(mutex_);
    wait_for_work();
    std::deque<Item> items = std::exchange(queue_, {});
    const uint64_t durable = durable_;
    const bool room_wanted = std::exchange(room_wanted_, false);
    const bool last = draining_ && items.empty();
    const bool patient = trouble_.empty() || now() < trouble_since_ + options_.patience;
    if (trouble_.empty()) gave_up_ = false;
    const std::string hopeless = patient || gave_up_ ? "" : trouble_;
    lock.unlock();

    append(std::move(items));
    settle(durable);
    set_unfinished_aside();
    if (try_again_at_ && now() >= *try_again_at_) {
      try_again_at_.reset();
      listener_.try_again();
    }
    if (!hopeless.empty()) {
      gave_up_ = true;
      listener_.storage_failed(hopeless);
    }
    if (last) break;
    compact_if_worthwhile(room_wanted);
  }
  if (log_) {
    const core::Status synced = log_->sync();
    if (!synced) listener_.storage_failed(synced.error().message);
    settle(log_->durable());
  }
  listener_.drained();
}

void FilmStore::append(std::deque<Item> items) {
  for (Item& item : items) {
    if (item.call) {
      item.call();
      continue;
    }
    if (log_ && !item.bytes.empty()) {
      const uint64_t bytes = item.bytes.size();
      auto sequence = log_->append(std::move(item.bytes));
      if (!sequence) {
        release(item.memory);
        listener_.not_persisted(item.id, sequence.error().message);
        try_again_at_ = now() + kTryAgain;
        continue;
      }
      item.sequence = *sequence;
      log_bytes_ += bytes;
      if (const auto* unit = std::get_if<UnitRecord>(&item.record)) {
        frame_bytes_[unit->accepted.unit.frame] += bytes;
      }
    } else {
      item.sequence = appended_.empty() ? 0 : appended_.back().sequence;
    }
    appended_.push_back(std::move(item));
  }
}

void FilmStore::settle(uint64_t durable) {
  while (!appended_.empty() && appended_.front().sequence <= durable) {
    Item item = std::move(appended_.front());
    appended_.pop_front();
    settling_ = &item;
    settled_sequence_ = std::max(settled_sequence_, item.sequence);
    apply(item.record);
    listener_.persisted(item.id);
    settling_ = nullptr;
    release(item.memory);
  }
}

/// What a record that is durable says of the films in memory. A unit's film waits for merge().
void FilmStore::apply(const Record& record) {
  std::visit(core::Overloaded{
                 [&](const UnitRecord& unit) {
                   own_thread_.assert_held();
                   const AcceptedUnit& accepted = unit.accepted;
                   if (accepted.worker_class.empty()) return;
                   classes_[accepted.unit.frame] = accepted.worker_class;
                 },
                 [&](const FrameFinishedRecord& done) {
                   own_thread_.assert_held();
                   finished_[done.frame] = {key_of(done.frame), set_.region};
                   unfinished_.erase(done.frame);
                 },
                 [](const FrameFailedRecord&) {},
                 [&](const FrameRestartedRecord& restarted) {
                   own_thread_.assert_held();
                   aside_.remove(restarted.frame);
                   films_.erase(restarted.frame);
                   classes_.erase(restarted.frame);
                   finished_.erase(restarted.frame);
                   unfinished_.erase(restarted.frame);
                 },
                 [&](const TileVoidedRecord& voided) {
                   own_thread_.assert_held();
                   if (is_aside(voided.frame)) return aside_.add(voided.frame, encode(voided));
                   const auto whole = films_.find(voided.frame);
                   if (whole == films_.end()) return;
                   // Whoever looks at the film meanwhile keeps what was there.
                   if (whole->second.use_count() > 1) {
                     whole->second = std::make_shared<core::Film>(*whole->second);
                   }
                   whole->second->erase(voided.tile);
                 },
                 [&](const DisputeRecord& dispute) {
                   own_thread_.assert_held();
                   disputed_ = dispute.open;
                 },
                 [](const DivergentWorkerRecord&) {},
             },
             record);
}

void FilmStore::release(uint64_t memory) {
  const core::MutexLock lock(mutex_);
  waiting_bytes_ -= memory;
  room_.notify_all();
}

core::Status FilmStore::merge(RecordId record) {
  own_thread_.assert_held();
  const UnitRecord* unit = settling_ != nullptr && settling_->id == record
                               ? std::get_if<UnitRecord>(&settling_->record)
                               : nullptr;
  if (unit == nullptr) return core::Error{"a film is to be merged that is not at hand"};
  if (!fetch(unit->accepted.unit.frame)) return {};
  auto& whole = films_[unit->accepted.unit.frame];
  const core::Film& film = settling_->film;
  if (!whole) {
    whole = std::make_shared<core::Film>(film.layout(), set_.region, film.splats().region());
  }
  const core::Status merged = whole->merge(film);
  core::failpoint("mid-merge");
  if (!merged) return merged;
  if (const core::Status fits = whole->check_id_room(); !fits) {
    // Whoever looks at the film meanwhile keeps what was there.
    whole = std::make_shared<core::Film>(film.layout(), set_.region, film.splats().region());
    listener_.outgrown(unit->accepted.unit.frame, fits.error().message);
  }
  return {};
}

std::shared_ptr<const core::Film> FilmStore::film(int32_t frame) const {
  own_thread_.assert_held();
  const auto it = films_.find(frame);
  return it == films_.end() ? nullptr : it->second;
}

core::Status FilmStore::set_aside(int32_t frame) {
  own_thread_.assert_held();
  const auto it = films_.find(frame);
  if (it == films_.end()) return {};
  if (!logs() || tile_size_ < 1) return core::Error{"films are kept in memory alone"};
  const auto alone = hold_whole_records();
  core::Status put = aside_.put(frame, *it->second, tile_size_, key_of(frame), class_of(frame));
  if (!put) return put;
  films_.erase(it);
  return {};
}

bool FilmStore::fetch(int32_t frame) {
  own_thread_.assert_held();
  if (!is_aside(frame)) return true;
  const auto read = [&] {
    own_thread_.assert_held();
    const auto alone = hold_whole_records();
    return aside_.read(frame);
  };
  const TimePoint end = now() + options_.patience;
  auto film = read();
  while (!film && !aside_.is_damaged() && wait_to_read(end)) film = read();
  aside_.remove(frame);
  if (!film) {
    // What comes would else be taken for all of it.
    listener_.outgrown(frame, "its film is lost: " + film.error().message);
    return false;
  }
  if (*film) films_[frame] = std::move(*film);
  return true;
}

void FilmStore::forget(int32_t frame, FrameEnd end) {
  own_thread_.assert_held();
  if (const auto bytes = frame_bytes_.extract(frame)) useless_bytes_ += bytes.mapped();
  const auto it = films_.find(frame);
  if (end == FrameEnd::unwritten && log_ && unfinished_.size() < kUnfinishedFilms) {
    if (it != films_.end()) {
      unfinished_anew_ = true;
      unfinished_[frame] = it->second;
      films_.erase(it);
    } else if (is_aside(frame)) {
      unfinished_[frame] = nullptr;
    }
    return;
  }
  aside_.remove(frame);
  if (it == films_.end()) return;
  if (end == FrameEnd::finished) classes_.erase(frame);
  films_.erase(it);
}

std::string FilmStore::class_of(int32_t frame) const {
  const auto known = classes_.find(frame);
  return known == classes_.end() ? std::string() : known->second;
}

/// Where records of all of a film are written or read: until the result goes nobody else does so.
/// The lock guards no member (core/base/mutex.h).
std::unique_lock<core::Mutex> FilmStore::hold_whole_records() const {
  if (!set_.splats || options_.whole_records == nullptr) return {};
  return std::unique_lock(*options_.whole_records);
}

/// Films that nobody counts any more leave memory, if they can.
void FilmStore::set_unfinished_aside() {
  if (!std::exchange(unfinished_anew_, false)) return;
  for (auto& [frame, film] : unfinished_) {
    if (!film) continue;
    films_[frame] = film;
    if (set_aside(frame)) film.reset();
    films_.erase(frame);
  }
}

/// Waits for a moment. Whether it is to be tried again.
bool FilmStore::wait_to_read(TimePoint end) {
  const TimePoint again = std::min(now() + kReadAgain, end);
  const core::MutexLock lock(mutex_);
  while (!draining_ && now() < again) wake_.wait_until(mutex_, again);
  return !draining_ && now() < end;
}

}  // namespace hyades::coordinator
