#pragma once

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/number.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Has a thread of `pool` answer with what `what` gives, a WebReply: for what may wait for the
/// disk.
template <class What>
void answer_by(ThreadPool& pool, const Answer& answer, What what) {
  const bool taken = pool.submit([answer, what = std::move(what)]() mutable {
    WebReply reply;
    const grpc::Status done = within_memory([&] {
      reply = what();
      return grpc::Status::OK;
    });
    answer(done.ok() ? std::move(reply) : error_reply(done));
  });
  if (!taken) answer(error_reply(crowded()));
}

/// The whole number that a route's {name} is; not found where it is none.
template <class Number>
std::optional<Number> parameter(const WebRequest& request, const char* name, const Answer& answer) {
  const std::string& text = request.parameters.at(name);
  const auto number = number_of<Number>(text);
  if (!number) {
    answer(
        error_reply({grpc::StatusCode::NOT_FOUND, fmt::format("there is no {} '{}'", name, text)}));
  }
  return number;
}

/// A value of the query; `fallback` where it is not given, nothing (and answered) where it is no
/// number.
template <class Number>
std::optional<Number> query_number(const WebRequest& request, const char* name, Number fallback,
                                   const Answer& answer) {
  const auto given = request.query.find(name);
  if (given == request.query.end()) return fallback;
  const auto number = number_of<Number>(given->second);
  if (!number) {
    answer(
        error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                     fmt::format("{}: expected a whole number, not '{}'", name, given->second)}));
  }
  return number;
}

/// The same of one that may be left out: `value` stays as it is then. False where it is no number
/// (and answered).
template <class Number>
bool query_number_if_any(const WebRequest& request, const char* name, std::optional<Number>& value,
                         const Answer& answer) {
  if (!request.query.contains(name)) return true;
  value = query_number<Number>(request, name, Number{}, answer);
  return value.has_value();
}

/// The same of a value that has to lie within [least, most] where it is given.
template <class Number>
std::optional<Number> query_within(const WebRequest& request, const char* name, Number least,
                                   Number most, Number fallback, const Answer& answer) {
  const auto number = query_number<Number>(request, name, fallback, answer);
  if (!number || !request.query.contains(name) || (*number >= least && *number <= most)) {
    return number;
  }
  answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                      fmt::format("{}: expected {} to {}, not {}", name, least, most, *number)}));
  return std::nullopt;
}

/// Whether something is wanted ("name", "name=true", "name=1"); nothing (and answered) where the
/// value is neither yes nor no.
inline std::optional<bool> query_flag(const WebRequest& request, const char* name,
                                      const Answer& answer) {
  const auto given = request.query.find(name);
  if (given == request.query.end()) return false;
  const std::string& value = given->second;
  if (value.empty() || value == "true" || value == "1") return true;
  if (value == "false" || value == "0") return false;
  answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                      fmt::format("{}: expected true or false, not '{}'", name, value)}));
  return std::nullopt;
}

/// A handler of routes with a {job}: `what(job, request, answer)`; not found where it is no number.
template <class What>
Router::Handler of_job(What what) {
  return [what = std::move(what)](const WebRequest& request, const Answer& answer) {
    const auto job = parameter<uint64_t>(request, "job", answer);
    if (job) what(*job, request, answer);
  };
}

/// The same where a thread of `pool` answers with what `what(job)` gives.
template <class What>
Router::Handler of_job_by(ThreadPool& pool, What what) {
  return of_job(
      [&pool, what = std::move(what)](uint64_t job, const WebRequest&, const Answer& answer) {
        answer_by(pool, answer, [what, job] { return what(job); });
      });
}

}  // namespace hyades::coordinator
