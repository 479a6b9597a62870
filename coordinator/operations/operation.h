#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "coordinator/access/rules.h"
#include "coordinator/operations/executors.h"
#include "coordinator/operations/handler.h"
#include "coordinator/operations/route.h"
#include "farm/wire.h"

namespace hyades::coordinator {

/// One thing that the coordinator can be asked for: a row of the table from which gRPC, HTTP, the
/// rules of access and the audit log come. One without a handler (a stream, an upload, a picture)
/// is served by hand in services/ and web/, for those who may by this row, where it says; pictures
/// have threads of their own.
struct Operation {
  Rule rule;
  const char* method = "";  ///< of gRPC: "Jobs/Cancel"; empty: none asks for it
  Runs runs = Runs::at_once;
  Handler handle{};
  std::vector<Route> routes{};                   ///< of HTTP
  uint64_t most_bytes = farm::kMaxRequestBytes;  ///< of a request
};

/// All rows of the table.
std::span<const Operation> all_operations();

/// The operation of a gRPC method ("Jobs/Cancel"). For a method on no row: one that only admins
/// may.
const Operation& operation_of_method(std::string_view method);
/// The operation of an HTTP route, as Route::path has it. For a route on no row: one that only
/// admins may.
const Operation& operation_of_route(std::string_view route);
/// The operation's route with this path; one without a query where it has none.
const Route& find_route(const Operation& operation, std::string_view route);

/// Carries out what an admitted caller asks for by `handle`, the operation's or a route's: looks
/// first whether the caller may steer the job that it is about, and notes in the audit log what
/// becomes of it. To be called on the thread that the operation runs on. `respond` keeps `request`
/// alive.
void carry_out(const Operation& operation, const Handler& handle, Backend& at, Message& request,
               const Caller& caller, const Respond<Message>& respond);

/// The route that stands for all files of the dashboard.
inline constexpr const char* kDashboardFiles = "GET /dashboard/{path...}";

// The rows, by subject.
std::vector<Operation> job_operations();
std::vector<Operation> asset_operations();
std::vector<Operation> farm_operations();
std::vector<Operation> token_operations();

}  // namespace hyades::coordinator
