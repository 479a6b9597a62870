#include "coordinator/job_store/copy_store.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// A table; its key comes first. `types`: a letter for each column: i(nteger), t(ext), b(ytes).
struct Table {
  const char* name;
  std::vector<std::string> columns;
  std::string_view types;
  size_t key_columns = 1;
  bool numbered = false;  ///< the database gives out the key
};

const std::vector<Table>& tables() {
  static const std::vector<Table> all{
      {"jobs",
       {"id",           "key",          "name",     "owner",       "owner_proven",  "priority",
        "options",      "state",        "frames",   "frames_done", "frames_failed", "samples",
        "samples_done", "submitted_ms", "begun_ms", "busy_ns",     "ended_ms",      "reason",
        "core_ns",      "preview"},
       "itttiibiiiiiiiiiitii",
       1,
       true},
      {"specs", {"job", "spec"}, "ib"},
      {"removals", {"job"}, "i"},
      {"frames",
       {"job", "frame", "done", "reason", "class", "restarts", "doubtful", "black"},
       "iiittiii",
       2},
      {"parts", {"job", "frame", "moment", "workers"}, "iiib", 2},
      {"outputs", {"number", "job", "path", "frame", "size", "sha256"}, "iitiib", 1, true},
      {"lines",
       {"number", "job", "time_ms", "level", "frame", "worker", "text"},
       "iiiiitt",
       1,
       true},
      {"quarantines", {"worker", "reason"}, "tt"},
      {"trusted", {"worker", "moment"}, "ti"},
      {"tokens",
       {"id", "name", "role", "hash", "created_ms", "expires_ms", "used_ms", "revoked_ms", "pool",
        "machines"},
       "ttibiiiiti"},
      {"core_time", {"owner", "hour", "core_ns"}, "tii", 2},
      {"secret", {"text"}, "t"},
  };
  return all;
}

/// Rows that are in memory at once: one spec may have megabytes.
constexpr int64_t kRows = 100;

std::string joined(const std::vector<std::string>& names, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return text;
}

void bind_column(Query& to, const Query& row, const Table& table, size_t column) {
  const int at = static_cast<int>(column);
  if (row.is_null(at)) {
    to.bind_null();
  } else if (table.types[column] == 'i') {
    to.bind(row.integer(at));
  } else if (table.types[column] == 't') {
    to.bind(std::string_view(row.bytes(at)));
  } else {
    to.bind_blob(row.bytes(at));
  }
}

/// A key as it was read, so that the next page can be asked for.
struct Key {
  std::array<int64_t, 2> integers{};
  std::array<std::string, 2> texts;
};

/// One page, of what comes after `last` (null: the first), which becomes the last one's. Rows.
core::Result<int64_t> copy_page(const StoreDatabase& from, const StoreDatabase& to,
                                const Table& table, bool first, Key& last) {
  const std::string columns = joined(table.columns, table.columns.size());
  const std::string keys = joined(table.columns, table.key_columns);
  const std::string after = table.key_columns == 1 ? "?" : "?, ?";
  Query rows(from.db,
             fmt::format("SELECT {} FROM {} {} ORDER BY {} LIMIT ?", columns, table.name,
                         first ? "" : fmt::format("WHERE ({}) > ({})", keys, after), keys));
  for (size_t i = 0; !first && i < table.key_columns; ++i) {
    if (table.types[i] == 'i') {
      rows.bind(last.integers[i]);
    } else {
      rows.bind(std::string_view(last.texts[i]));
    }
  }
  rows.bind(kRows);
  // SQLite's first schema had a column that has no default, and is of no use any more.
  const bool old = to.engine == SqlEngine::sqlite && std::string_view(table.name) == "jobs";
  std::string places = "?";
  for (size_t i = 1; i < table.columns.size(); ++i) places += ", ?";
  const std::string insert = fmt::format("INSERT INTO {} ({}{}) VALUES ({}{})", table.name, columns,
                                         old ? ", max_workers" : "", places, old ? ", 0" : "");
  int64_t count = 0;
  for (; rows.next(); ++count) {
    Query one(to.db, insert);
    for (size_t i = 0; i < table.columns.size(); ++i) bind_column(one, rows, table, i);
    if (core::Status done = one.run(); !done) return done.error().in(table.name);
    for (size_t i = 0; i < table.key_columns; ++i) {
      const int at = static_cast<int>(i);
      if (table.types[i] == 'i') {
        last.integers[i] = rows.integer(at);
      } else {
        last.texts[i] = rows.bytes(at);
      }
    }
  }
  if (core::Status read = rows.status(); !read) return read.error().in(table.name);
  return count;
}

/// The last number that `table` has given out, also to what is gone.
core::Result<int64_t> last_number(const StoreDatabase& from, const Table& table) {
  const bool sqlite = from.engine == SqlEngine::sqlite;
  Query query(from.db,
              sqlite ? fmt::format("SELECT seq FROM sqlite_sequence WHERE name = '{}'", table.name)
                     : fmt::format("SELECT CASE WHEN is_called THEN last_value ELSE 0 END FROM "
                                   "{}_{}_seq",
                                   table.name, table.columns[0]));
  const int64_t number = query.next() ? query.integer(0) : 0;
  if (core::Status read = query.status(); !read) return read.error();
  return number;
}

core::Status go_on_after(const StoreDatabase& to, const Table& table, int64_t number) {
  if (number == 0) return {};
  if (to.engine == SqlEngine::postgres) {
    Query set(to.db, fmt::format("SELECT setval('{}_{}_seq', ?)", table.name, table.columns[0]));
    return set.bind(number).run();
  }
  // A table that has never given out a number has no row there.
  Query gone(to.db, fmt::format("DELETE FROM sqlite_sequence WHERE name = '{}'", table.name));
  if (core::Status done = gone.run(); !done) return done;
  Query set(to.db, fmt::format("INSERT INTO sqlite_sequence VALUES ('{}', ?)", table.name));
  return set.bind(number).run();
}

core::Status copy_table(const StoreDatabase& from, const StoreDatabase& to, const Table& table) {
  Key last;
  int64_t count = kRows;
  for (bool first = true; count == kRows; first = false) {
    const auto copied = copy_page(from, to, table, first, last);
    if (!copied) return copied.error();
    count = *copied;
  }
  if (!table.numbered) return {};
  const auto number = last_number(from, table);
  return number ? go_on_after(to, table, *number) : number.error();
}

core::Status refuse_used(const StoreDatabase& to) {
  for (const char* table : {"jobs", "tokens", "quarantines", "trusted"}) {
    Query some(to.db, fmt::format("SELECT 1 FROM {} LIMIT 1", table));
    const bool any = some.next();
    if (core::Status read = some.status(); !read) return read;
    if (any) return core::Error{fmt::format("there are {} already: expected an empty one", table)};
  }
  return {};
}

}  // namespace

core::Status copy_store(const StoreDatabase& from, const StoreDatabase& to) {
  Transaction transaction(to.db);
  if (core::Status begun = transaction.status(); !begun) return begun;
  if (core::Status empty = refuse_used(to); !empty) return empty;
  if (core::Status gone = Query(to.db, "DELETE FROM secret").run(); !gone) return gone;
  for (const Table& table : tables()) {
    if (core::Status copied = copy_table(from, to, table); !copied) return copied;
  }
  return transaction.commit();
}

}  // namespace hyades::coordinator
