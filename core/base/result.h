#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace hyades::core {

/// What went wrong, in words meant for the person who can mend it: what was found, what was
/// expected, and where ("scene.yaml:12:7: ...", "dragon.ply: ...").
struct Error {
  std::string message;

  /// This error with "context: " put before it.
  Error in(const std::string& context) const { return {context + ": " + message}; }
};

/// A value or the reason why there is none. Used by parsing, input and output; never inside render
/// loops. value() on an error is a bug of the caller (std::get throws).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit on purpose
  Result(Error error)
      : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit on purpose

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success, or the reason for failure.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: implicit on purpose

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

}  // namespace hyades::core
