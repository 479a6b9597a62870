#include "coordinator/shared_state/migrate_farm.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/film_store/disk_film_logs.h"
#include "coordinator/film_store/log_names.h"
#include "coordinator/job_store/copy_store.h"
#include "coordinator/job_store/incarnation_file.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/job_store/schema.h"
#include "coordinator/shared_state/database_film_logs.h"
#include "coordinator/shared_state/leader_lease.h"
#include "coordinator/shared_state/lease_rows.h"
#include "coordinator/sql/postgres.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kPiece = uint64_t{1} << 20U;
/// A leader that is there renews its lease within that; one that is gone is not waited for longer.
constexpr std::chrono::seconds kPatience{10};

/// What a coordinator keeps in its folder beside its state and films.
constexpr std::array kShared = {"assets", "outputs", "machine-key", "admin-token", "farm-id"};
constexpr std::array kLogs = {"audit", "refusals", "uploads"};  // audit.jsonl, audit.1.jsonl, ...

/// The lease of the database's farm, which nobody else has; an error where somebody leads.
core::Result<std::unique_ptr<LeaderLease>> lead(const std::string& database) {
  LeaderOptions options;
  options.database = database;
  options.holder = "hyades migrate";
  std::string leader;
  options.tell = [&leader](const LeaseRow& row, const std::string&) { leader = row.holder; };
  options.pause = [end = std::chrono::steady_clock::now() + kPatience](auto time) {
    std::this_thread::sleep_for(time);
    return std::chrono::steady_clock::now() < end;
  };
  auto lease = LeaderLease::wait(options);
  if (!lease || *lease) return lease;
  return core::Error{without_password(database) + ": " + leader +
                     " leads: expected that no coordinator runs"};
}

core::Result<uint64_t> copy_log_file(LogFiles& from, LogFiles& to, const std::string& source,
                                     const std::string& target) {
  auto reader = from.open(source);
  if (!reader) return reader.error();
  auto writer = to.create(target);
  if (!writer) return writer.error();
  const uint64_t size = (*reader)->size();
  std::vector<std::byte> piece;
  for (uint64_t at = 0; at < size; at += piece.size()) {
    piece.resize(std::min(kPiece, size - at));
    if (core::Status read = (*reader)->read(at, piece); !read) return read.error();
    if (core::Status written = (*writer)->write(piece); !written) return written.error();
  }
  if (core::Status synced = (*writer)->sync(); !synced) return synced.error();
  return size;
}

core::Status copy_log(FilmLogs& from, FilmLogs& to, uint64_t job, MigratedFarm& done) {
  const std::string source = from.folder(job);
  const std::string target = to.folder(job);
  const auto names = from.files().list(source);
  if (!names) return names.error();
  if (core::Status made = to.files().make_folder(target); !made) return made;
  // What an attempt before has left.
  to.remove(job, UINT64_MAX);
  if (core::Status made = to.files().make_folder(target); !made) return made;
  for (const std::string& name : *names) {
    if (!is_log_file(name) || name == kLockName || name.ends_with(kUnfinishedSuffix)) continue;
    const auto bytes =
        copy_log_file(from.files(), to.files(), source + "/" + name, target + "/" + name);
    if (!bytes) return bytes.error();
    done.log_bytes += *bytes;
  }
  ++done.logs;
  return to.files().sync_folder(target);
}

core::Status copy_logs(FilmLogs& from, FilmLogs& to, MigratedFarm& done) {
  const auto jobs = from.jobs();
  if (!jobs) return jobs.error();
  for (const uint64_t job : *jobs) {
    if (core::Status copied = copy_log(from, to, job, done); !copied) return copied;
  }
  return {};
}

/// Files and folders of a coordinator that both homes have.
std::vector<fs::path> shared_paths(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    const bool shared = std::find(kShared.begin(), kShared.end(), name) != kShared.end();
    const bool log = name.ends_with(".jsonl") &&
                     std::any_of(kLogs.begin(), kLogs.end(), [&](const std::string& kind) {
                       return name.starts_with(kind + ".");
                     });
    if (shared || log) paths.push_back(entry.path());
  }
  return paths;
}

core::Status copy_files(const std::string& from, const std::string& to, MigratedFarm& done) {
  std::error_code failed;
  fs::create_directories(to, failed);
  if (failed) return core::Error{to + ": " + failed.message()};
  if (fs::equivalent(from, to, failed)) return {};
  for (const fs::path& path : shared_paths(from)) {
    fs::copy(path, fs::path(to) / path.filename(),
             fs::copy_options::recursive | fs::copy_options::overwrite_existing, failed);
    if (failed) return core::Error{path.string() + ": " + failed.message()};
    done.files +=
        fs::is_directory(path)
            ? static_cast<uint64_t>(std::count_if(
                  fs::recursive_directory_iterator(path), fs::recursive_directory_iterator(),
                  [](const auto& entry) { return entry.is_regular_file(); }))
            : 1;
  }
  const core::Descriptor folder = core::open_file(to, O_RDONLY | O_DIRECTORY);
  if (!folder.valid() || ::syncfs(folder.get()) != 0) {
    return core::Error{to + ": what was copied there may not outlast a loss of power"};
  }
  return {};
}

std::unique_ptr<FilmLogs> logs_in_database(const PostgresOptions& connection) {
  return database_film_logs(std::make_unique<DatabaseLogFiles>(connection), {});
}

/// So that no coordinator goes on in the database: they find no farm there.
core::Status hide_tables(const std::string& database, uint64_t incarnation) {
  auto db = open_postgres(leader_connection(database, incarnation, {}));
  if (!db) return db.error();
  Transaction transaction(**db);
  core::Status done = transaction.status();
  if (done) {
    done = (*db)->run_script(fmt::format("ALTER SCHEMA {} RENAME TO {}_migrated_{}",
                                         kPostgresSchema, kPostgresSchema, incarnation));
  }
  return done ? transaction.commit() : done;
}

/// The number of the last start in the folder.
core::Result<uint64_t> count_folder(const std::string& state) {
  auto store = open_sqlite_job_store(state);
  if (!store) return store.error();
  return (*store)->next_incarnation();
}

core::Status raise_database(const std::string& database, uint64_t incarnation) {
  auto db = open_postgres({.url = database});
  if (!db) return db.error();
  if (core::Status made = prepare_postgres(**db); !made) return made;
  // One that was killed still has its lease for a while.
  {
    const auto lease = lead(database);
    if (!lease) return lease.error();
  }
  return raise_incarnation(**db, incarnation);
}

}  // namespace

core::Result<MigratedFarm> migrate_to_database(const FarmHomes& homes) {
  const std::string state = homes.folder + "/state.db";
  if (!fs::exists(state)) {
    return core::Error{homes.folder +
                       ": expected the folder of a coordinator (there is no state.db)"};
  }
  // What starts in the database comes after all that has started in the folder.
  const auto starts = count_folder(state);
  if (!starts) return starts.error();
  if (core::Status raised = raise_database(homes.database, *starts); !raised) return raised.error();
  const auto lease = lead(homes.database);
  if (!lease) return lease.error();
  const uint64_t incarnation = (*lease)->incarnation();
  if (incarnation <= *starts) {
    return core::Error{without_password(homes.database) +
                       ": a coordinator has led meanwhile: expected that none runs"};
  }
  MigratedFarm done;
  {
    const auto from = open_job_database(state);
    if (!from) return from.error();
    const PostgresOptions connection = leader_connection(homes.database, incarnation, {});
    const auto to = open_postgres(connection);
    if (!to) return to.error();
    const auto logs = disk_film_logs(homes.folder + "/films");
    const auto new_logs = logs_in_database(connection);
    core::Status copied = copy_files(homes.folder, homes.files, done);
    if (copied) copied = copy_logs(*logs, *new_logs, done);
    // Last: until then the database holds no farm.
    if (copied) copied = copy_store({**from, SqlEngine::sqlite}, {**to, SqlEngine::postgres});
    if (!copied) return copied.error();
  }
  std::error_code failed;
  fs::rename(state, state + ".migrated", failed);
  if (failed) return core::Error{state + ": " + failed.message() + "; move it away"};
  return done;
}

core::Result<MigratedFarm> migrate_to_folder(const FarmHomes& homes) {
  const std::string state = homes.folder + "/state.db";
  std::error_code failed;
  fs::create_directories(homes.folder, failed);
  if (fs::exists(state)) {
    return core::Error{state + ": expected a folder without a farm"};
  }
  const auto lease = lead(homes.database);
  if (!lease) return lease.error();
  const uint64_t incarnation = (*lease)->incarnation();
  const std::string unfinished = state + ".new";
  for (const char* suffix : {"", "-wal", "-journal"}) fs::remove(unfinished + suffix, failed);
  MigratedFarm done;
  {
    const PostgresOptions connection = leader_connection(homes.database, incarnation, {});
    const auto from = open_postgres(connection);
    if (!from) return from.error();
    const auto to = open_job_database(unfinished);
    if (!to) return to.error();
    const auto logs = logs_in_database(connection);
    const auto new_logs = disk_film_logs(homes.folder + "/films");
    core::Status copied = copy_files(homes.files, homes.folder, done);
    if (copied) copied = copy_logs(*logs, *new_logs, done);
    if (copied) copied = copy_store({**from, SqlEngine::postgres}, {**to, SqlEngine::sqlite});
    if (!copied) return copied.error();
  }
  const auto counted = count_start(state + ".starts", incarnation);
  if (!counted) return counted.error();
  fs::rename(unfinished, state, failed);
  if (failed) return core::Error{state + ": " + failed.message()};
  (void)core::sync_folder(homes.folder);
  if (core::Status hidden = hide_tables(homes.database, incarnation); !hidden) {
    return core::Error{"the farm was moved, but the database still holds it (" +
                       hidden.error().message + "): expected no coordinator there any more"};
  }
  return done;
}

}  // namespace hyades::coordinator
