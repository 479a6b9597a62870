#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "coordinator/sql/connection.h"
#include "coordinator/sql/postgres_url.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// How a PostgreSQL database is reached, and by whom.
struct PostgresOptions {
  /// postgresql://USER@HOST[,HOST...]/DATABASE[?...], or libpq's KEY=VALUE form.
  std::string url;
  /// What pg_stat_activity tells of the connection (application_name).
  std::string name = "hyades";
  /// Who leads (leader_lease.h): each transaction that writes begins with making sure that this is
  /// still so, and holds on to it until its end. Nothing: whoever may.
  std::optional<uint64_t> incarnation{};
  /// For the answer to one statement; what takes longer ends the connection.
  std::chrono::milliseconds patience{30'000};
  /// Called once, from within a statement, where the connection is lost or another coordinator
  /// leads. What had been sent may have been done.
  std::function<void(const std::string& why)> on_lost{};
};

/// What a statement's failure is called where another coordinator has taken over.
inline constexpr const char* kOtherLeads = "another coordinator leads now";

/// The schema (a namespace of PostgreSQL's) in which all tables of a farm are.
inline constexpr const char* kPostgresSchema = "hyades";

/// Connects; each host has three seconds for it, or `options.patience` where that is less. What is
/// committed is durable, whatever the server's default (synchronous_commit is on); standbys of the
/// database are passed over. A transaction that nobody goes on with for two seconds is ended, so
/// that a frozen process holds nobody up. Texts that PostgreSQL has none for (a zero byte, what is
/// no UTF-8) are stored with question marks instead. An error names the host, never the password.
core::Result<std::unique_ptr<SqlConnection>> open_postgres(const PostgresOptions& options);

}  // namespace hyades::coordinator
