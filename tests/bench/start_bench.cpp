// How soon a coordinator answers after its start, and what memory it takes: empty, and with 100,000
// jobs that have ended and 1,000 that have not, copies of one job; its data are read from the disk.
#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tests/bench/bench_coordinator.h"

namespace hyades::bench {
namespace {

constexpr int kRounds = 5;
constexpr int kEnded = 100'000;
constexpr int kOpen = 1'000;
constexpr int kDone = 3;  // StoredState::done

double megabytes(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("VmRSS:", 0) == 0) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

void ask(sqlite3* db, const std::string& sql) {
  char* error = nullptr;
  if (sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &error) != SQLITE_OK) give_up(error);
}

std::string columns_of_jobs(sqlite3* db) {
  std::string columns;
  const auto take = [](void* to, int, char** values, char**) {
    const std::string name = values[0];
    if (name != "id" && name != "key" && name != "state") {
      static_cast<std::string*>(to)->append(", " + name);
    }
    return 0;
  };
  sqlite3_exec(db, "SELECT name FROM pragma_table_info('jobs')", take, &columns, nullptr);
  return columns;
}

/// As if the one job that is there had been submitted many times.
void multiply(const std::string& file) {
  sqlite3* db = nullptr;
  if (sqlite3_open(file.c_str(), &db) != SQLITE_OK) give_up(file + " cannot be opened");
  const std::string columns = columns_of_jobs(db);
  const auto copies = [&](int count, const std::string& state) {
    ask(db, "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
                std::to_string(count) + ") INSERT INTO jobs (key, state" + columns + ") SELECT '" +
                state + " ' || i, " + state + columns +
                " FROM n, (SELECT * FROM jobs ORDER BY id LIMIT 1)");
  };
  ask(db, "BEGIN");
  copies(kEnded, std::to_string(kDone));
  ask(db,
      "INSERT INTO frames (job, frame, done, reason, class, restarts) "
      "SELECT id, 1, 1, '', 'class', 0 FROM jobs WHERE state = " +
          std::to_string(kDone));
  ask(db,
      "INSERT INTO outputs (job, path, frame, size, sha256) "
      "SELECT id, 'noise.0001.exr', 1, 1000, zeroblob(32) FROM jobs WHERE state = " +
          std::to_string(kDone));
  ask(db,
      "INSERT INTO lines (job, time_ms, level, worker, text) "
      "SELECT id, 0, 1, '', 'done' FROM jobs WHERE state = " +
          std::to_string(kDone));
  copies(kOpen - 1, "state");
  ask(db, "COMMIT");
  sqlite3_close(db);
}

/// Until a call is answered.
void answer(const CoordinatorProcess& coordinator) {
  grpc::ClientContext context;
  farm::prepare(context, {}, std::chrono::seconds(60));
  context.set_wait_for_ready(true);
  v1::ListJobsResponse jobs;
  const auto status =
      v1::Jobs::NewStub(coordinator.connect())->List(&context, v1::ListJobsRequest(), &jobs);
  if (!status.ok()) give_up(status.error_message());
}

/// What is in memory of the folder's files leaves it, as after a restart of the machine.
void forget_cached(const std::string& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const int file = open(entry.path().c_str(), O_RDONLY);
    if (file < 0 || fdatasync(file) != 0 || posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED) != 0)
      give_up(entry.path().string() + " cannot be taken out of memory");
    close(file);
  }
}

void measure(const std::string& folder, const char* what) {
  std::vector<double> walls;
  std::vector<double> cpus;
  double memory = 0;
  for (int i = 0; i < kRounds; ++i) {
    forget_cached(folder);
    const auto begin = std::chrono::steady_clock::now();
    const CoordinatorProcess coordinator(folder);
    answer(coordinator);
    walls.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    cpus.push_back(cpu_seconds(coordinator.process()));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    memory = megabytes(coordinator.process());
  }
  std::sort(walls.begin(), walls.end());
  std::sort(cpus.begin(), cpus.end());
  std::printf("%s: answers after %.2f s (%.2f s of CPU; medians), takes %.1f MiB when idle\n", what,
              walls[kRounds / 2], cpus[kRounds / 2], memory);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hyades::bench

int main() {
  const hyades::test::TempFolder scratch;
  const std::string folder = scratch.file("data");
  {
    const hyades::bench::CoordinatorProcess coordinator(folder);
    hyades::bench::answer(coordinator);
  }
  hyades::bench::measure(folder, "without jobs");
  {
    const hyades::bench::CoordinatorProcess coordinator(folder);
    hyades::bench::submit(coordinator.connect(),
                          "hyades: 1\nname: noise\nframes: {range: 1-100}\nfilm: {size: [1920, "
                          "1080]}\nenvironment: {color: 1}\noutputs: [{file: noise.####.exr}]\n");
  }
  hyades::bench::multiply(folder + "/state.db");
  hyades::bench::measure(folder, "100,000 ended and 1,000 open jobs");
}
