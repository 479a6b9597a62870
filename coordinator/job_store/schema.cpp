// The schema's history in SQLite (postgres_schema.cpp has that of the other engine). A step is
// never changed once it has been released; a change is a new step.
#include "coordinator/job_store/schema.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <sstream>

#include <fmt/format.h>

#include "coordinator/job_store/new_secret.h"
#include "core/base/failpoint.h"

namespace hyades::coordinator {
namespace {

/// Step i brings a file from version i to version i + 1 (kept in user_version).
constexpr std::array kSteps = {
    R"(
CREATE TABLE starts (incarnation INTEGER PRIMARY KEY);
CREATE TABLE jobs (
  id INTEGER PRIMARY KEY AUTOINCREMENT,  -- never used twice: films and logs are named by it
  key TEXT UNIQUE,
  spec BLOB NOT NULL,
  name TEXT NOT NULL,
  owner TEXT NOT NULL,
  priority INTEGER NOT NULL,
  max_workers INTEGER NOT NULL,
  state INTEGER NOT NULL,
  frames INTEGER NOT NULL,
  frames_done INTEGER NOT NULL,
  frames_failed INTEGER NOT NULL,
  samples INTEGER NOT NULL,
  submitted_ms INTEGER NOT NULL,
  ended_ms INTEGER NOT NULL,
  reason TEXT NOT NULL);
CREATE INDEX open_jobs ON jobs (id) WHERE state < 3;
CREATE TABLE frames (
  job INTEGER NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  frame INTEGER NOT NULL,
  done INTEGER NOT NULL,
  reason TEXT NOT NULL,
  class TEXT NOT NULL,
  restarts INTEGER NOT NULL,
  PRIMARY KEY (job, frame)) WITHOUT ROWID;
CREATE TABLE outputs (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  job INTEGER NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  path TEXT NOT NULL,
  frame INTEGER NOT NULL,
  size INTEGER NOT NULL,
  sha256 BLOB NOT NULL,
  UNIQUE (job, path));
CREATE INDEX outputs_of_job ON outputs (job, number);
CREATE TABLE lines (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  job INTEGER NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  time_ms INTEGER NOT NULL,
  level INTEGER NOT NULL,
  frame INTEGER,
  worker TEXT NOT NULL,
  text TEXT NOT NULL);
CREATE INDEX lines_of_job ON lines (job, number);
)",
    R"(
CREATE TABLE quarantines (worker TEXT PRIMARY KEY, reason TEXT NOT NULL) WITHOUT ROWID;
)",
    R"(
ALTER TABLE jobs ADD COLUMN tags TEXT NOT NULL DEFAULT '';  -- between commas
ALTER TABLE jobs ADD COLUMN memory INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN max_attempts INTEGER NOT NULL DEFAULT 3;
ALTER TABLE jobs ADD COLUMN frame_order INTEGER NOT NULL DEFAULT 1;
)",
    R"(
ALTER TABLE frames ADD COLUMN doubtful INTEGER NOT NULL DEFAULT 0;
CREATE INDEX doubtful_frames ON frames (job, frame) WHERE doubtful;
CREATE TABLE parts (  -- of finished frames: who had one
  job INTEGER NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  frame INTEGER NOT NULL,
  moment INTEGER NOT NULL,
  workers BLOB NOT NULL,  -- see contributor_rows.h
  PRIMARY KEY (job, frame)) WITHOUT ROWID;
CREATE TABLE trusted (worker TEXT PRIMARY KEY, moment INTEGER NOT NULL) WITHOUT ROWID;
)",
    R"(
ALTER TABLE jobs ADD COLUMN core_ns INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN preview INTEGER;
CREATE INDEX outputs_of_frame ON outputs (job, frame);
)",
    R"(
CREATE TABLE tokens (  -- who may come in; see token_rows.h
  id TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  role INTEGER NOT NULL,
  hash BLOB NOT NULL,
  created_ms INTEGER NOT NULL,
  expires_ms INTEGER NOT NULL,
  used_ms INTEGER NOT NULL,
  revoked_ms INTEGER NOT NULL) WITHOUT ROWID;
)",
    R"(
ALTER TABLE jobs ADD COLUMN owner_proven INTEGER NOT NULL DEFAULT 0;
UPDATE jobs SET owner_proven = 1 WHERE owner IN
  (SELECT name FROM tokens WHERE tokens.created_ms <= jobs.submitted_ms);
)",
    R"(
-- Instead of max_workers, tags, memory, max_attempts and frame_order, which stay as they are: to
-- drop them would write all rows once more.
ALTER TABLE jobs ADD COLUMN options BLOB NOT NULL DEFAULT x'';
UPDATE jobs SET options = job_options(max_workers, tags, memory, max_attempts, frame_order);
)",
    R"(
CREATE TABLE secret (text TEXT NOT NULL);  -- one row: JobStore::secret()
INSERT INTO secret VALUES (new_secret());
)",
    R"(
ALTER TABLE tokens ADD COLUMN pool TEXT NOT NULL DEFAULT '';
)",
    R"(
CREATE TABLE core_time (  -- what threads took for results, by the hour: jobs may be forgotten
  owner TEXT NOT NULL,
  hour INTEGER NOT NULL,  -- since 1970, UTC
  core_ns INTEGER NOT NULL,
  PRIMARY KEY (owner, hour)) WITHOUT ROWID;
CREATE TRIGGER count_core_time AFTER UPDATE OF core_ns ON jobs WHEN NEW.core_ns > OLD.core_ns
BEGIN
  DELETE FROM core_time
    WHERE owner = NEW.owner AND hour < CAST(strftime('%s', 'now') AS INTEGER) / 3600 - 25;
  INSERT INTO core_time (owner, hour, core_ns)
    VALUES (NEW.owner, CAST(strftime('%s', 'now') AS INTEGER) / 3600, NEW.core_ns - OLD.core_ns)
    ON CONFLICT (owner, hour) DO UPDATE SET core_ns = core_ns + excluded.core_ns;
END;
)",
    R"(
-- Tokens that are there already go on to be good for as many workers as a farm may have.
ALTER TABLE tokens ADD COLUMN machines INTEGER NOT NULL DEFAULT 20000;
)",
    R"(
ALTER TABLE jobs ADD COLUMN samples_done INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN begun_ms INTEGER NOT NULL DEFAULT 0;
)",
    R"(
ALTER TABLE jobs ADD COLUMN busy_ns INTEGER NOT NULL DEFAULT 0;
)",
    R"(
CREATE TABLE removals (job INTEGER PRIMARY KEY);  -- gone, with rows of it left: removals.h
)",
    R"(
CREATE TABLE specs (  -- megabytes, apart from what is listed and changed
  job INTEGER PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
  spec BLOB NOT NULL);
INSERT INTO specs SELECT id, spec FROM jobs;
ALTER TABLE jobs DROP COLUMN spec;
CREATE INDEX jobs_of_owner ON jobs (owner, id);
)",
    R"(
ALTER TABLE frames ADD COLUMN black INTEGER NOT NULL DEFAULT 0;
CREATE INDEX black_frames ON frames (job, frame) WHERE black;
)",
};

/// A number as protobuf writes it.
void put(std::string& bytes, uint64_t number) {
  for (; number > 127; number >>= 7U) bytes += static_cast<char>(number | 128U);
  bytes += static_cast<char>(number);
}

/// For the step that adds options: the fields 17 to 21 of v1::Job, which this room does not know.
void job_options(sqlite3_context* context, int count, sqlite3_value** values) {
  constexpr uint64_t kFirst = 17;
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    const uint64_t tag = (kFirst + static_cast<uint64_t>(i)) << 3U;
    if (sqlite3_value_type(values[i]) != SQLITE_TEXT) {
      const int64_t number = sqlite3_value_int64(values[i]);
      if (number == 0) continue;
      put(bytes, tag);
      put(bytes, static_cast<uint64_t>(number));
      continue;
    }
    std::istringstream texts(reinterpret_cast<const char*>(sqlite3_value_text(values[i])));
    for (std::string text; std::getline(texts, text, ',');) {
      put(bytes, tag | 2U);
      put(bytes, text.size());
      bytes += text;
    }
  }
  sqlite3_result_blob(context, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
}

/// For the step that adds the secret.
void give_secret(sqlite3_context* context, int /*count*/, sqlite3_value** /*values*/) {
  const auto secret = new_secret();
  if (!secret) return sqlite3_result_error(context, "the system gives no random numbers", -1);
  sqlite3_result_text(context, secret->data(), static_cast<int>(secret->size()), SQLITE_TRANSIENT);
}

constexpr int kSchemaVersion = static_cast<int>(kSteps.size());

}  // namespace

core::Status migrate(SqliteConnection& db) {
  int64_t version = 0;
  {
    Query read(db, "PRAGMA user_version");
    if (read.next()) version = read.integer(0);
    if (core::Status known = read.run(); !known) return known;
  }
  if (version > kSchemaVersion) {
    return core::Error{fmt::format(
        "was written by a newer Hyades (schema {}, this one knows up to {}); use that one", version,
        kSchemaVersion)};
  }
  if (sqlite3_create_function(db.get(), "job_options", 5, SQLITE_UTF8 | SQLITE_DETERMINISTIC,
                              nullptr, job_options, nullptr, nullptr) != SQLITE_OK ||
      sqlite3_create_function(db.get(), "new_secret", 0, SQLITE_UTF8, nullptr, give_secret, nullptr,
                              nullptr) != SQLITE_OK) {
    return core::Error{sqlite3_errmsg(db.get())};
  }
  for (int64_t step = version; step < kSchemaVersion; ++step) {
    Transaction transaction(db);
    if (core::Status begun = transaction.status(); !begun) return begun;
    if (core::Status made = db.run_script(kSteps[static_cast<size_t>(step)]); !made) {
      return core::Error{
          fmt::format("schema {} could not be made: {}", step + 1, made.error().message)};
    }
    core::failpoint("mid-migration");
    if (core::Status noted = Query(db, fmt::format("PRAGMA user_version={}", step + 1)).run();
        !noted) {
      return noted;
    }
    if (core::Status done = transaction.commit(); !done) return done;
  }
  return {};
}

core::Result<std::unique_ptr<SqliteConnection>> open_job_database(const std::string& path) {
  auto db = open_sqlite(path);
  if (!db) return db;
  if (core::Status migrated = migrate(**db); !migrated) return migrated.error().in(path);
  return db;
}

}  // namespace hyades::coordinator
