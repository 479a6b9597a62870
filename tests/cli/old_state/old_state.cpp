// usage: old_state OLD.db LIVE.db
// Fills OLD.db, a job store of an older schema without rows, with the jobs of LIVE.db: what an
// older coordinator would have left behind.
#include <sqlite3.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using Row = std::vector<std::string>;

std::vector<Row> ask(sqlite3* db, const std::string& sql) {
  std::vector<Row> rows;
  char* error = nullptr;
  const auto take = [](void* to, int columns, char** values, char**) {
    static_cast<std::vector<Row>*>(to)->emplace_back(values, values + columns);
    return 0;
  };
  if (sqlite3_exec(db, sql.c_str(), take, &rows, &error) != SQLITE_OK) {
    std::fprintf(stderr, "%s: %s\n", sql.c_str(), error);
    std::exit(1);
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  sqlite3* db = nullptr;
  if (argc != 3 || sqlite3_open_v2(argv[1], &db, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK) {
    std::fprintf(stderr, "usage: old_state OLD.db LIVE.db\n");
    return 2;
  }
  ask(db, "ATTACH '" + std::string(argv[2]) + "' AS live");
  for (const Row& table : ask(db,
                              "SELECT name FROM main.sqlite_master WHERE type = 'table' AND "
                              "name NOT LIKE 'sqlite_%'")) {
    std::string columns;
    std::string values;
    for (const Row& column : ask(db, "SELECT name FROM pragma_table_info('" + table[0] + "')")) {
      const bool moved = table[0] == "jobs" && column[0] == "spec";
      columns += (columns.empty() ? "" : ", ") + column[0];
      values += values.empty() ? "" : ", ";
      values += moved ? "(SELECT spec FROM live.specs WHERE job = id)" : column[0];
    }
    ask(db, "INSERT INTO main." + table[0] + " (" + columns + ") SELECT " + values + " FROM live." +
                table[0]);
  }
  return sqlite3_close(db) == SQLITE_OK ? 0 : 1;
}
