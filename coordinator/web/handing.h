#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/services/desks.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Has one of `clerks` answer with what `what` gives, a WebReply: for what may wait for the disk.
template <class What>
void answer_by(Clerks& clerks, const Answer& answer, What what) {
  const bool taken = clerks.hand([answer, what = std::move(what)]() mutable {
    WebReply reply;
    const grpc::Status done = within_memory([&] {
      reply = what();
      return grpc::Status::OK;
    });
    answer(done.ok() ? std::move(reply) : error_reply(done));
  });
  if (!taken) answer(error_reply(crowded()));
}

/// The whole number that a part of the path or a value of the query is.
template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// The same of a route's {name}; not found where it is none.
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

inline bool query_flag(const WebRequest& request, const char* name) {
  const auto given = request.query.find(name);
  return given != request.query.end() && given->second != "false" && given->second != "0";
}

}  // namespace hyades::coordinator
