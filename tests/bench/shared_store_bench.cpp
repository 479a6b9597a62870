// Film logs of a farm with several coordinators, in PostgreSQL, beside the same logs on the disk:
// results made durable per second, by one log and by several at once. Options, beside those of
// every benchmark: --database=URL (else a server of its own, with little memory), --folder=FOLDER
// (for what is on the disk).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "coordinator/film_store/film_log.h"
#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/shared_state/database_log_files.h"
#include "coordinator/sql/postgres.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

constexpr int64_t kMixed = 0;                      ///< a size: films of 1 to 8 MB
constexpr uint64_t kWindow = uint64_t{32} << 20U;  ///< bytes on their way, of each log

/// Where logs lie, as an argument.
enum Where : int64_t { disk, database };

struct Places {
  std::string folder;
  std::unique_ptr<DatabaseLogFiles> database;
};
Places places;

/// Bytes that do not compress, as films' do not.
std::vector<std::byte> film_of(size_t size) {
  std::vector<std::byte> bytes(size);
  uint64_t state = 1;
  for (std::byte& b : bytes) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    b = static_cast<std::byte>(state >> 56U);
  }
  return bytes;
}

/// What a log has made durable.
struct Progress {
  std::mutex mutex;
  std::condition_variable moved;
  uint64_t durable = 0;

  void wait_for(uint64_t sequence) {
    std::unique_lock lock(mutex);
    moved.wait(lock, [&] { return durable >= sequence; });
  }
};

/// A log for each thread: records are appended as fast as they become durable.
void film_logs(benchmark::State& state) {
  const int64_t size = state.range(0);
  LogFiles& files = state.range(1) == disk ? disk_log_files() : *places.database;
  std::vector<std::vector<std::byte>> films;
  if (size == kMixed) {
    for (const size_t megabytes : {1U, 8U, 2U, 4U, 1U, 2U})
      films.push_back(film_of(megabytes << 20U));
  } else {
    films.push_back(film_of(static_cast<size_t>(size)));
  }
  uint64_t mean = 0;
  for (const auto& film : films) mean += film.size() / films.size();
  const uint64_t window = std::max<uint64_t>(1, std::min<uint64_t>(4000, kWindow / mean));

  Progress progress;
  FilmLogOptions options;
  options.files = &files;
  options.on_durable = [&](uint64_t through) {
    const std::lock_guard lock(progress.mutex);
    progress.durable = through;
    progress.moved.notify_one();
  };
  options.on_trouble = [](const core::Error& error) {
    std::fprintf(stderr, "%s\n", error.message.c_str());
  };
  const std::string folder = fmt::format("{}/{}", places.folder, state.thread_index());
  auto log = FilmLog::open(folder, "bench", options);
  if (!log || !(*log)->replay([](std::span<const std::byte>) { return core::Status(); })) {
    state.SkipWithError("the log does not open");
    return;
  }
  uint64_t last = 0;
  uint64_t bytes = 0;
  for (auto _ : state) {
    if (last >= window) progress.wait_for(last + 1 - window);
    const auto& film = films[last % films.size()];
    const auto sequence = (*log)->append(film);
    if (!sequence) {
      state.SkipWithError(sequence.error().message.c_str());
      break;
    }
    last = *sequence;
    bytes += film.size();
    if (static_cast<int64_t>(last) == static_cast<int64_t>(state.max_iterations)) {
      progress.wait_for(last);
    }
  }
  state.SetItemsProcessed(static_cast<int64_t>(last));
  state.SetBytesProcessed(static_cast<int64_t>(bytes));
  log->reset();
  if (!erase_film_log(folder, &files)) std::fprintf(stderr, "the log cannot be removed\n");
}

BENCHMARK(film_logs)
    ->ArgNames({"bytes", "database"})
    ->ArgsProduct({{4096, 65536, 262144, kMixed}, {disk, database}})
    ->Threads(1)
    ->Threads(8)
    ->UseRealTime();

}  // namespace

/// Prepares a database for logs; false where it cannot be used.
bool prepare_places(const std::string& url, const std::string& folder) {
  auto db = open_postgres({.url = url});
  if (!db || !prepare_postgres(**db)) return false;
  Query leader(**db, "SELECT incarnation FROM leader");
  if (!leader.next()) return false;
  PostgresOptions options;
  options.url = url;
  options.incarnation = static_cast<uint64_t>(leader.integer(0));
  places.folder = folder + "/logs";
  places.database = std::make_unique<DatabaseLogFiles>(options);
  return true;
}

}  // namespace hyades::coordinator

int main(int argc, char** argv) {
  const hyades::test::TempFolder scratch;
  std::string url;
  std::string folder = scratch.path().string();
  std::vector<char*> arguments(argv, argv + argc);
  std::string seconds = "--benchmark_min_time=5";
  arguments.insert(arguments.begin() + 1, seconds.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option.starts_with("--database=")) url = option.substr(11);
    if (option.starts_with("--folder=")) folder = option.substr(9);
  }
  std::unique_ptr<hyades::test::PostgresServer> server;
  if (url.empty()) {
    server = std::make_unique<hyades::test::PostgresServer>(true);
    url = server->make_database();
  }
  if (!hyades::coordinator::prepare_places(url, folder)) {
    std::fprintf(stderr, "the database cannot be used\n");
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  hyades::coordinator::places = {};
}
