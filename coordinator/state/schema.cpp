// The schema's history. A step is never changed once it has been released; a change is a new step.
#include <array>

#include <fmt/format.h>

#include "coordinator/state/database.h"
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
  workers BLOB NOT NULL,  -- see parts.h
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
};

}  // namespace

const int kSchemaVersion = static_cast<int>(kSteps.size());

core::Status migrate(sqlite3* db) {
  Query read(db, "PRAGMA user_version");
  const int64_t version = read.next() ? read.integer(0) : 0;
  if (core::Status known = read.run(); !known) return known;
  if (version > kSchemaVersion) {
    return core::Error{fmt::format(
        "was written by a newer Hyades (schema {}, this one knows up to {}); use that one", version,
        kSchemaVersion)};
  }
  for (int64_t step = version; step < kSchemaVersion; ++step) {
    Transaction transaction(db);
    if (core::Status begun = transaction.status(); !begun) return begun;
    char* error = nullptr;
    if (sqlite3_exec(db, kSteps[static_cast<size_t>(step)], nullptr, nullptr, &error) !=
        SQLITE_OK) {
      const std::string why = error;
      sqlite3_free(error);
      return core::Error{fmt::format("schema {} could not be made: {}", step + 1, why)};
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

}  // namespace hyades::coordinator
