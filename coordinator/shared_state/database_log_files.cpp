#include "coordinator/shared_state/database_log_files.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

namespace hyades::coordinator {
namespace {

using core::Error;
using core::Result;
using core::Status;

constexpr size_t kConnections = 8;  ///< each log has a thread of its own, and waits for the disk
constexpr std::chrono::seconds kWaitForConnection{20};
constexpr std::chrono::seconds kReadAgainFor{30};
constexpr std::chrono::milliseconds kReadAgainAfter{100};

/// Of a row, and of what is read at once: PostgreSQL has each of them in memory several times.
constexpr size_t kChunkBytes = size_t{1} << 20U;
/// What is read ahead, at first and at most: records are read one after the other, or one alone.
constexpr size_t kAheadFirst = size_t{16} << 10U;
constexpr size_t kAheadMost = kChunkBytes;

/// A path as the tables have it.
struct Place {
  explicit Place(const std::string& path) {
    const size_t slash = path.rfind('/');
    if (slash != std::string::npos) folder = path.substr(0, slash);
    name = path.substr(slash + 1);
  }
  std::string folder;
  std::string name;
};

Error cannot(const std::string& what, const std::string& path, const std::string& why) {
  return {"cannot " + what + " " + path + ": " + why};
}

constexpr const char* kMissing = "there is no such file";

Result<std::optional<int64_t>> find_file(SqlConnection& db, const std::string& path) {
  const Place place(path);
  Query query(db, "SELECT id FROM log_files WHERE folder = ? AND name = ?");
  std::optional<int64_t> id;
  if (query.bind(place.folder).bind(place.name).next()) id = query.integer(0);
  if (Status read = query.status(); !read) return read.error();
  return id;
}

/// The file, which is there.
Result<int64_t> file_at(SqlConnection& db, const std::string& path) {
  const auto id = find_file(db, path);
  if (!id) return id.error();
  if (!*id) return Error{kMissing};
  return **id;
}

/// Removes the file's chunks that begin at `from` or later.
Status remove_chunks(SqlConnection& db, int64_t file, uint64_t from) {
  return Query(db, "DELETE FROM log_chunks WHERE file = ? AND position >= ?")
      .bind(file)
      .bind(number(from))
      .run();
}

Status remove_file(SqlConnection& db, int64_t file) {
  if (Status done = remove_chunks(db, file, 0); !done) return done;
  return Query(db, "DELETE FROM log_files WHERE id = ?").bind(file).run();
}

/// The piece of a file that begins at `position`. A file that is gone gets none.
Status add_chunk(SqlConnection& db, int64_t file, uint64_t position, std::string_view bytes) {
  Query insert(db,
               "INSERT INTO log_chunks (file, position, size, bytes) "
               "SELECT id, ?, ?, ? FROM log_files WHERE id = ?");
  insert.bind(number(position)).bind(number(bytes.size())).bind_blob(bytes).bind(file);
  if (Status done = insert.run(); !done) return done;
  return insert.changed() == 1 ? Status() : Error{"it was removed"};
}

}  // namespace

/// Appends chunks to a file.
class DatabaseLogFiles::Writer final : public LogWriter {
 public:
  Writer(DatabaseLogFiles& files, std::string path, int64_t file)
      : files_(files), path_(std::move(path)), file_(file) {}

  Status write(std::span<const std::byte> bytes) override {
    return checked("write", [&] {
      if (pending_.size() + bytes.size() < kChunkBytes) return append(bytes);
      return files_.write([&](SqlConnection& db) { return put_whole_chunks(db, bytes); });
    });
  }

  Status sync() override {
    return checked("sync", [&] {
      if (pending_.empty()) return Status();
      return files_.write([&](SqlConnection& db) { return put_pending(db); });
    });
  }

 private:
  /// After an error some of what was written may be missing: nothing may follow it.
  template <class Act>
  Status checked(const char* what, const Act& act) {
    if (failed_) return cannot(what, path_, "that has failed before");
    const Status done = act();
    failed_ = !done;
    if (failed_) return cannot(what, path_, done.error().message);
    return {};
  }

  Status append(std::span<const std::byte> bytes) {
    pending_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return {};
  }

  Status put_whole_chunks(SqlConnection& db, std::span<const std::byte> bytes) {
    while (pending_.size() + bytes.size() >= kChunkBytes) {
      const size_t some = kChunkBytes - pending_.size();
      (void)append(bytes.first(some));
      bytes = bytes.subspan(some);
      if (Status put = put_pending(db); !put) return put;
    }
    return append(bytes);
  }

  Status put_pending(SqlConnection& db) {
    if (Status put = add_chunk(db, file_, end_, pending_); !put) return put;
    end_ += pending_.size();
    pending_.clear();
    return {};
  }

  DatabaseLogFiles& files_;
  const std::string path_;
  const int64_t file_;
  uint64_t end_ = 0;     ///< of the rows
  std::string pending_;  ///< comes after them
  bool failed_ = false;
};

/// Reads a file's chunks, a little ahead.
class DatabaseLogFiles::Reader final : public LogReader {
 public:
  Reader(DatabaseLogFiles& files, std::string path, int64_t file, uint64_t size)
      : files_(files), path_(std::move(path)), file_(file), size_(size) {}

  /// One that cannot be read now.
  Reader(DatabaseLogFiles& files, std::string path, std::string trouble)
      : Reader(files, std::move(path), 0, 0) {
    trouble_ = std::move(trouble);
  }

  uint64_t size() const override { return size_; }
  std::string passing_trouble() const override { return trouble_; }

  Status read(uint64_t offset, std::span<std::byte> into) override {
    if (!trouble_.empty()) return Error{trouble_};
    if (offset > size_ || into.size() > size_ - offset) return failed("it ends too early");
    while (!into.empty()) {
      size_t some = 0;
      if (offset >= begin_ && offset - begin_ < ahead_.size()) {
        const auto at = static_cast<size_t>(offset - begin_);
        some = std::min(into.size(), ahead_.size() - at);
        std::memcpy(into.data(), ahead_.data() + at, some);
      } else if (into.size() >= kAheadMost) {
        some = kChunkBytes;
        if (Status done = fetch(offset, into.first(some)); !done) return done;
      } else if (Status done = look_ahead(offset, into.size()); !done) {
        return done;
      }
      offset += some;
      into = into.subspan(some);
    }
    return {};
  }

 private:
  Error failed(const std::string& why) const { return cannot("read", path_, why); }

  /// Has what stands at `offset` at hand, `least` bytes of it and more.
  Status look_ahead(uint64_t offset, size_t least) {
    const bool goes_on = offset == begin_ + ahead_.size();
    step_ = goes_on ? std::min(2 * step_, kAheadMost) : kAheadFirst;
    std::vector<std::byte> bytes(
        static_cast<size_t>(std::min<uint64_t>(std::max(step_, least), size_ - offset)));
    ahead_.clear();
    if (Status done = fetch(offset, bytes); !done) return done;
    begin_ = offset;
    ahead_ = std::move(bytes);
    return {};
  }

  Status fetch(uint64_t offset, std::span<std::byte> into) {
    bool whole = false;
    Status done = files_.read([&](SqlConnection& db) {
      // Of each chunk what lies between ?2 and ?3; a chunk that was cut may have more bytes.
      Query rows(db,
                 "SELECT position, size, SUBSTR(bytes, "
                 "CAST(CASE WHEN position < ?2 THEN ?2 - position ELSE 0 END AS INTEGER) + 1, "
                 "CAST(?3 - CASE WHEN position < ?2 THEN ?2 ELSE position END AS INTEGER)) "
                 "FROM log_chunks WHERE file = ?1 AND position < ?3 AND position >= "
                 "(SELECT MAX(position) FROM log_chunks WHERE file = ?1 AND position <= ?2) "
                 "ORDER BY position");
      rows.bind(file_).bind(number(offset)).bind(number(offset + into.size()));
      size_t got = 0;
      while (got < into.size() && rows.next()) {
        const uint64_t at = offset + got;
        const auto position = static_cast<uint64_t>(rows.integer(0));
        const uint64_t end = position + static_cast<uint64_t>(rows.integer(1));
        const bool follows = got == 0 ? position <= at : position == at;
        const std::string bytes = rows.bytes(2);
        if (!follows || end <= at || bytes.empty()) break;
        const auto some =
            static_cast<size_t>(std::min<uint64_t>({bytes.size(), end - at, into.size() - got}));
        std::memcpy(into.data() + got, bytes.data(), some);
        got += some;
      }
      whole = got == into.size();
      return rows.status();
    });
    if (!done) {
      const Error why = failed(done.error().message);
      trouble_ = why.message;
      return why;
    }
    if (!whole) return failed("it ends too early");
    return {};
  }

  DatabaseLogFiles& files_;
  const std::string path_;
  const int64_t file_;
  const uint64_t size_;
  std::string trouble_;  ///< of the database
  uint64_t begin_ = 0;   ///< of what was read ahead
  std::vector<std::byte> ahead_;
  size_t step_ = kAheadFirst / 2;
};

class DatabaseLogFiles::Lock final : public LogLock {
 public:
  Lock(DatabaseLogFiles& files, std::string path) : files_(files), path_(std::move(path)) {}
  ~Lock() override {
    const core::MutexLock hold(files_.mutex_);
    files_.locked_.erase(path_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  DatabaseLogFiles& files_;
  const std::string path_;
};

DatabaseLogFiles::DatabaseLogFiles(const PostgresOptions& database)
    : DatabaseLogFiles(postgres_connections(database), kConnections, kReadAgainFor) {}

DatabaseLogFiles::DatabaseLogFiles(ConnectionPool::Open open, size_t connections,
                                   std::chrono::milliseconds patience)
    : pool_(std::move(open), connections, kWaitForConnection), patience_(patience) {}

/// Does what only reads; again where that failed with its connection.
Status DatabaseLogFiles::read(const Work& work) {
  const auto end = std::chrono::steady_clock::now() + patience_;
  while (true) {
    Status done;
    bool again = true;
    {
      auto db = pool_.take();
      done = db ? work(**db) : db.error();
      if (db) again = db->is_lost();
    }
    if (done || !again || std::chrono::steady_clock::now() >= end) return done;
    std::this_thread::sleep_for(kReadAgainAfter);
  }
}

/// Does it in one transaction.
Status DatabaseLogFiles::write(const Work& work) {
  auto db = pool_.take();
  if (!db) return db.error();
  Transaction transaction(**db);
  Status done = transaction.status();
  if (done) done = work(**db);
  return done ? transaction.commit() : done;
}

Result<std::vector<std::string>> DatabaseLogFiles::list(const std::string& folder) {
  std::vector<std::string> names;
  Status done = read([&](SqlConnection& db) {
    names.clear();
    Query rows(db, "SELECT name FROM log_files WHERE folder = ?");
    rows.bind(folder);
    while (rows.next()) names.push_back(rows.bytes(0));
    return rows.status();
  });
  if (!done) return cannot("list", folder, done.error().message);
  return names;
}

Result<std::vector<std::string>> DatabaseLogFiles::folders() {
  std::vector<std::string> names;
  Status done = read([&](SqlConnection& db) {
    names.clear();
    Query rows(db, "SELECT DISTINCT folder FROM log_files");
    while (rows.next()) names.push_back(rows.bytes(0));
    return rows.status();
  });
  if (!done) return done.error();
  return names;
}

Result<std::unique_ptr<LogWriter>> DatabaseLogFiles::create(const std::string& path) {
  int64_t id = 0;
  const Status done = write([&](SqlConnection& db) -> Status {
    const Place place(path);
    Query insert(db,
                 "INSERT INTO log_files (folder, name) VALUES (?, ?) "
                 "ON CONFLICT DO NOTHING RETURNING id");
    const bool made = insert.bind(place.folder).bind(place.name).next();
    if (made) id = insert.integer(0);
    if (Status run = insert.run(); !run) return run;
    return made ? Status() : Error{"there is a file already"};
  });
  if (!done) return cannot("create", path, done.error().message);
  return std::unique_ptr<LogWriter>(std::make_unique<Writer>(*this, path, id));
}

Result<std::unique_ptr<LogReader>> DatabaseLogFiles::open(const std::string& path) {
  int64_t id = 0;
  uint64_t size = 0;
  bool found = false;
  const Place place(path);
  Status done = read([&](SqlConnection& db) {
    Query row(db,
              "SELECT id, (SELECT position + size FROM log_chunks WHERE file = id "
              "ORDER BY position DESC LIMIT 1) FROM log_files WHERE folder = ? AND name = ?");
    found = row.bind(place.folder).bind(place.name).next();
    if (found) {
      id = row.integer(0);
      size = row.is_null(1) ? 0 : static_cast<uint64_t>(row.integer(1));
    }
    return row.status();
  });
  if (done && !found) return cannot("open", path, kMissing);
  if (!done) {
    const Error why = cannot("open", path, done.error().message);
    return std::unique_ptr<LogReader>(std::make_unique<Reader>(*this, path, why.message));
  }
  return std::unique_ptr<LogReader>(std::make_unique<Reader>(*this, path, id, size));
}

Status DatabaseLogFiles::rename(const std::string& from, const std::string& to) {
  const Status done = write([&](SqlConnection& db) -> Status {
    const auto id = file_at(db, from);
    if (!id) return id.error();
    const auto before = find_file(db, to);
    if (!before) return before.error();
    if (*before == *id) return {};
    if (*before) {
      if (Status removed = remove_file(db, **before); !removed) return removed;
    }
    const Place place(to);
    return Query(db, "UPDATE log_files SET folder = ?, name = ? WHERE id = ?")
        .bind(place.folder)
        .bind(place.name)
        .bind(*id)
        .run();
  });
  if (!done) return cannot("rename " + from + " to", to, done.error().message);
  return {};
}

Status DatabaseLogFiles::remove(const std::string& path) {
  const Status done = write([&](SqlConnection& db) -> Status {
    const auto id = file_at(db, path);
    return id ? remove_file(db, *id) : id.error();
  });
  if (!done) return cannot("remove", path, done.error().message);
  return {};
}

Status DatabaseLogFiles::truncate(const std::string& path, uint64_t size) {
  const Status done = write([&](SqlConnection& db) -> Status {
    const auto id = file_at(db, path);
    if (!id) return id.error();
    if (Status removed = remove_chunks(db, *id, size); !removed) return removed;
    // The bytes behind the new end stay where they are, unread: they go with the chunk.
    return Query(db,
                 "UPDATE log_chunks SET size = ?2 - position "
                 "WHERE file = ?1 AND position < ?2 AND position + size > ?2")
        .bind(*id)
        .bind(number(size))
        .run();
  });
  if (!done) return cannot("shorten", path, done.error().message);
  return {};
}

Result<std::unique_ptr<LogLock>> DatabaseLogFiles::lock(const std::string& path) {
  const core::MutexLock hold(mutex_);
  if (!locked_.insert(path).second) return Error{path + " is held by this process already"};
  return std::unique_ptr<LogLock>(std::make_unique<Lock>(*this, path));
}

Status DatabaseLogFiles::remove_garbage() {
  return write([](SqlConnection& db) {
    return Query(db,
                 "DELETE FROM log_chunks WHERE NOT EXISTS "
                 "(SELECT 1 FROM log_files WHERE id = log_chunks.file)")
        .run();
  });
}

}  // namespace hyades::coordinator
