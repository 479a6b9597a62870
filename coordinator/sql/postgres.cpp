#include "coordinator/sql/postgres.h"

#include <endian.h>
#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

struct EndConnection {
  void operator()(PGconn* connection) const { PQfinish(connection); }
};
struct ClearResult {
  void operator()(PGresult* result) const { PQclear(result); }
};
using ResultPtr = std::unique_ptr<PGresult, ClearResult>;

/// The first line of what PostgreSQL says, without the word that they all begin with.
std::string first_line(const char* message) {
  std::string_view line = message == nullptr ? std::string_view() : message;
  line = line.substr(0, line.find('\n'));
  for (const std::string_view word : {"ERROR:  ", "FATAL:  "}) {
    if (line.starts_with(word)) line.remove_prefix(word.size());
  }
  return std::string(line);
}

/// What several hosts say, each in a line of its own.
std::string in_one_line(const char* message) {
  std::string_view text = message == nullptr ? std::string_view() : message;
  while (text.ends_with('\n')) text.remove_suffix(1);
  std::string line;
  for (const char c : text) {
    if (c != '\t') line += c == '\n' ? std::string("; ") : std::string(1, c);
  }
  return line;
}

/// What PostgreSQL takes as a text: what is no UTF-8, or a zero, comes as a question mark.
std::string as_text(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const size_t size = bytes.front() == '\0' ? 0 : core::utf8_length(bytes);
    text += size == 0 ? "?" : bytes.substr(0, size);
    bytes.remove_prefix(std::max<size_t>(size, 1));
  }
  return text;
}

/// Waits for the socket; false where `end` comes before.
bool wait_for(int socket, int16_t events, Clock::time_point end) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd watched{socket, events, 0};
    const int ready = ::poll(&watched, 1, static_cast<int>(std::min<int64_t>(left, 60'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

/// Parameters `?` and `?1` as PostgreSQL has them: `$1`. Quoted texts stay.
std::string with_dollars(std::string_view sql) {
  std::string text;
  int last = 0;
  bool quoted = false;
  for (size_t i = 0; i < sql.size(); ++i) {
    if (sql[i] == '\'') quoted = !quoted;
    if (sql[i] != '?' || quoted) {
      text += sql[i];
      continue;
    }
    text += '$';
    const bool numbered =
        i + 1 < sql.size() && std::isdigit(static_cast<unsigned char>(sql[i + 1]));
    if (!numbered) text += std::to_string(++last);
  }
  return text;
}

/// Whether it reads alone.
bool only_reads(std::string_view sql) {
  return sql.substr(std::min(sql.size(), sql.find_first_not_of(" \n"))).starts_with("SELECT");
}

constexpr size_t kMostNames = 500;  ///< of prepared statements

struct Value {
  std::string bytes;
  bool null = true;
  bool binary = false;
};

class PostgresConnection final : public SqlConnection {
 public:
  PostgresConnection(PostgresOptions options, std::unique_ptr<PGconn, EndConnection> connection)
      : options_(std::move(options)), connection_(std::move(connection)) {}

  std::unique_ptr<SqlStatement> prepare(std::string_view sql, std::string& error) override;

  core::Status run_script(const std::string& sql) override {
    return status_of(finished(PQsendQuery(connection_.get(), sql.c_str())));
  }

  core::Status begin(Durability durability) override {
    open_ = true;
    const std::string begin =
        durability == Durability::durable ? "BEGIN" : "BEGIN; SET LOCAL synchronous_commit = off";
    if (!options_.incarnation) return run_script(begin);
    // Whoever takes over has to change this row, and waits for the end of the transaction. In one
    // message with the beginning, since each answer is waited for.
    const std::string fence = fmt::format(
        "{}; SELECT 1 FROM leader WHERE incarnation = {} FOR SHARE", begin, *options_.incarnation);
    auto result = finished(PQsendQuery(connection_.get(), fence.c_str()));
    if (result && PQntuples(result->get()) == 1) return {};
    roll_back();
    if (!result) return result.error();
    lose(kOtherLeads);
    return core::Error{kOtherLeads};
  }

  core::Status commit() override {
    open_ = false;
    auto result = finished(PQsendQuery(connection_.get(), "COMMIT"));
    if (!result) return result.error();
    // A transaction that has failed is rolled back, which is no error to PostgreSQL.
    if (std::strcmp(PQcmdStatus(result->get()), "COMMIT") == 0) return {};
    return core::Error{"the transaction was rolled back"};
  }

  void roll_back() override {
    if (std::exchange(open_, false)) (void)run_script("ROLLBACK");
  }

  /// Runs a statement, in a transaction of its own where none is open and it writes.
  core::Result<ResultPtr> run(const std::string& sql, const std::vector<Value>& values) {
    if (open_ || only_reads(sql) || !options_.incarnation) return ask(sql, values);
    if (core::Status begun = begin(Durability::durable); !begun) return begun.error();
    auto result = ask(sql, values);
    if (!result) {
      roll_back();
      return result;
    }
    if (core::Status done = commit(); !done) return done.error();
    return result;
  }

 private:
  core::Result<ResultPtr> ask(const std::string& sql, const std::vector<Value>& values) {
    std::vector<const char*> pointers;
    std::vector<int> lengths;
    std::vector<int> formats;
    for (const Value& value : values) {
      pointers.push_back(value.null ? nullptr : value.bytes.c_str());
      lengths.push_back(static_cast<int>(value.bytes.size()));
      formats.push_back(value.binary ? 1 : 0);
    }
    const auto name = prepared(sql);
    if (!name) return name.error();
    return finished(PQsendQueryPrepared(connection_.get(), name->c_str(),
                                        static_cast<int>(values.size()), pointers.data(),
                                        lengths.data(), formats.data(), 1));
  }

  /// The statement's name, once the database has parsed it; that takes it longer than most answers.
  core::Result<std::string> prepared(const std::string& sql) {
    const auto known = names_.find(sql);
    if (known != names_.end()) return known->second;
    // What is asked in so many ways gets no name: the last one asked has the empty one.
    std::string name = names_.size() < kMostNames ? fmt::format("s{}", names_.size()) : "";
    auto parsed = finished(PQsendPrepare(connection_.get(), name.c_str(), sql.c_str(), 0, nullptr));
    if (!parsed) return parsed.error();
    if (!name.empty()) names_.emplace(sql, name);
    return name;
  }

  static core::Status status_of(const core::Result<ResultPtr>& result) {
    return result ? core::Status() : result.error();
  }

  /// The result of what was sent (the last one of several statements, or the first error).
  core::Result<ResultPtr> finished(int sent) {
    if (!lost_.empty()) return core::Error{lost_};
    if (sent == 0) return lost(first_line(PQerrorMessage(connection_.get())));
    const Clock::time_point end = Clock::now() + options_.patience;
    PGconn* const connection = connection_.get();
    for (int left = PQflush(connection); left != 0; left = PQflush(connection)) {
      if (left < 0) return lost(first_line(PQerrorMessage(connection)));
      if (!wait_for(PQsocket(connection), POLLOUT | POLLIN, end)) return silent();
      if (PQconsumeInput(connection) == 0) return lost(first_line(PQerrorMessage(connection)));
    }
    ResultPtr last;
    while (true) {
      while (PQisBusy(connection) != 0) {
        if (!wait_for(PQsocket(connection), POLLIN, end)) return silent();
        if (PQconsumeInput(connection) == 0) return lost(first_line(PQerrorMessage(connection)));
      }
      ResultPtr result(PQgetResult(connection));
      if (!result) break;
      if (!last || !has_failed(last.get())) last = std::move(result);
    }
    if (PQstatus(connection) == CONNECTION_BAD) return lost(why(last.get()));
    if (!last) return core::Error{"the database gave no answer"};
    if (is_read_only(last.get())) return lost(why(last.get()));
    if (has_failed(last.get())) return core::Error{why(last.get())};
    return last;
  }

  static bool has_failed(const PGresult* result) {
    const ExecStatusType status = PQresultStatus(result);
    return status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK && status != PGRES_EMPTY_QUERY;
  }

  /// The database has become another one's standby: there is a new primary to connect to.
  static bool is_read_only(const PGresult* result) {
    const char* state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
    return state != nullptr && std::strcmp(state, "25006") == 0;
  }

  std::string why(const PGresult* result) const {
    const char* text = result == nullptr ? nullptr : PQresultErrorMessage(result);
    return first_line(text != nullptr && *text != '\0' ? text : PQerrorMessage(connection_.get()));
  }

  core::Error silent() {
    return lost(fmt::format("the database has not answered for {:g} s",
                            std::chrono::duration<double>(options_.patience).count()));
  }

  core::Error lost(const std::string& why) {
    lose(why);
    return {why};
  }

  /// Nothing goes through this connection any more.
  void lose(const std::string& why) {
    connection_.reset();  // libpq refuses whatever is asked of none
    if (lost_.empty()) lost_ = why;
    if (auto tell = std::exchange(options_.on_lost, nullptr)) tell(why);
  }

  PostgresOptions options_;
  std::unique_ptr<PGconn, EndConnection> connection_;
  std::string lost_;                                    ///< why there is no connection any more
  bool open_ = false;                                   ///< a transaction
  std::unordered_map<std::string, std::string> names_;  ///< of statements that are prepared
};

class PostgresStatement final : public SqlStatement {
 public:
  PostgresStatement(PostgresConnection& connection, std::string sql)
      : connection_(connection), sql_(std::move(sql)) {}

  core::Status bind_integer(int parameter, int64_t value) override {
    return bind(parameter, {std::to_string(value), false, false});
  }
  core::Status bind_text(int parameter, std::string_view text) override {
    return bind(parameter, {as_text(text), false, false});
  }
  core::Status bind_blob(int parameter, std::string_view bytes) override {
    return bind(parameter, {std::string(bytes), false, true});
  }
  core::Status bind_null(int parameter) override { return bind(parameter, {}); }

  core::Result<bool> step() override {
    if (!result_) {
      auto result = connection_.run(sql_, values_);
      if (!result) return result.error();
      result_ = std::move(*result);
      values_.clear();
      row_ = -1;
    }
    return ++row_ < PQntuples(result_.get());
  }

  int64_t integer(int column) const override {
    int64_t big = 0;
    if (PQgetlength(result_.get(), row_, column) == 4) {
      int32_t value = 0;
      std::memcpy(&value, PQgetvalue(result_.get(), row_, column), sizeof value);
      return static_cast<int32_t>(be32toh(static_cast<uint32_t>(value)));
    }
    if (PQgetlength(result_.get(), row_, column) != sizeof big) return 0;
    std::memcpy(&big, PQgetvalue(result_.get(), row_, column), sizeof big);
    return static_cast<int64_t>(be64toh(static_cast<uint64_t>(big)));
  }
  bool is_null(int column) const override { return PQgetisnull(result_.get(), row_, column) != 0; }
  std::string bytes(int column) const override {
    return {PQgetvalue(result_.get(), row_, column),
            static_cast<size_t>(PQgetlength(result_.get(), row_, column))};
  }
  int64_t changed() const override {
    const std::string_view text = result_ ? PQcmdTuples(result_.get()) : "";
    int64_t rows = 0;  // and of a statement that counts none
    std::from_chars(text.data(), text.data() + text.size(), rows);
    return rows;
  }

 private:
  core::Status bind(int parameter, Value value) {
    values_.resize(std::max(values_.size(), static_cast<size_t>(parameter)));
    values_[static_cast<size_t>(parameter) - 1] = std::move(value);
    return {};
  }

  PostgresConnection& connection_;
  const std::string sql_;
  std::vector<Value> values_;
  ResultPtr result_;
  int row_ = -1;
};

std::unique_ptr<SqlStatement> PostgresConnection::prepare(std::string_view sql,
                                                          std::string& /*error*/) {
  return std::make_unique<PostgresStatement>(*this, with_dollars(sql));
}

/// How long one host has for letting somebody in, in seconds: others may have their turns.
std::string seconds_for_a_host(std::chrono::milliseconds patience) {
  constexpr int64_t kMost = 3;
  return std::to_string(
      std::clamp<int64_t>(std::chrono::ceil<std::chrono::seconds>(patience).count(), 1, kMost));
}

constexpr const char* kSession =
    "SET search_path = hyades, pg_catalog;"
    "SET idle_in_transaction_session_timeout = '2s';"
    "SET lock_timeout = '10s';"
    // What a role or database says for people who forget their sessions.
    "SET statement_timeout = 0;"
    "SET idle_session_timeout = 0;"
    "SET default_transaction_isolation = 'read committed';"
    "SET client_min_messages = warning;"
    "SET synchronous_commit = on";

}  // namespace

core::Result<std::unique_ptr<SqlConnection>> open_postgres(const PostgresOptions& options) {
  // libpq's own words on what it cannot read would show the password.
  if (!names_a_database(options.url)) {
    return core::Error{
        "this is no URL of a PostgreSQL database; expected "
        "postgresql://USER:PASSWORD@HOST/DATABASE "
        "with special characters as %XX"};
  }
  const std::vector<std::pair<const char*, std::string>> parameters{
      {"target_session_attrs", "read-write"},
      {"keepalives_idle", "2"},
      {"keepalives_interval", "1"},
      {"keepalives_count", "3"},
      {"tcp_user_timeout", "5000"},
      {"connect_timeout", seconds_for_a_host(options.patience)},
      {"dbname", options.url},  // what it says counts more than the above
      {"client_encoding", "UTF8"},
      {"application_name", options.name},
  };
  std::vector<const char*> names;
  std::vector<const char*> values;
  for (const auto& [name, value] : parameters) {
    names.push_back(name);
    values.push_back(value.c_str());
  }
  names.push_back(nullptr);
  values.push_back(nullptr);
  const std::string where = without_password(options.url);
  std::unique_ptr<PGconn, EndConnection> raw(PQconnectdbParams(names.data(), values.data(), 1));
  if (!raw) return core::Error{where + ": no memory"};
  if (PQstatus(raw.get()) != CONNECTION_OK) {
    return core::Error{where + ": " + in_one_line(PQerrorMessage(raw.get()))};
  }
  PQsetnonblocking(raw.get(), 1);
  PQsetNoticeProcessor(
      raw.get(), [](void*, const char*) {}, nullptr);  // else standard error
  auto connection = std::make_unique<PostgresConnection>(options, std::move(raw));
  if (core::Status set = connection->run_script(kSession); !set) return set.error().in(where);
  return std::unique_ptr<SqlConnection>(std::move(connection));
}

}  // namespace hyades::coordinator
