#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/geometry/ply_header.h"
#include "core/geometry/text_scanner.h"

namespace hyades::core {

/// Reads one binary value; Swap: its bytes are in the other order than the machine's.
template <class T, bool Swap>
T load_value(const char* at) {
  T value;
  if constexpr (Swap && sizeof(T) > 1) {
    char turned[sizeof(T)];
    for (size_t i = 0; i < sizeof(T); ++i) turned[i] = at[sizeof(T) - 1 - i];
    std::memcpy(&value, turned, sizeof(T));
  } else {
    std::memcpy(&value, at, sizeof(T));
  }
  return value;
}

/// A binary value as To (float or int64_t).
template <class To, bool Swap>
To load_as(PlyType type, const char* at) {
  switch (type) {
    case PlyType::int8:
      return static_cast<To>(load_value<int8_t, Swap>(at));
    case PlyType::uint8:
      return static_cast<To>(load_value<uint8_t, Swap>(at));
    case PlyType::int16:
      return static_cast<To>(load_value<int16_t, Swap>(at));
    case PlyType::uint16:
      return static_cast<To>(load_value<uint16_t, Swap>(at));
    case PlyType::int32:
      return static_cast<To>(load_value<int32_t, Swap>(at));
    case PlyType::uint32:
      return static_cast<To>(load_value<uint32_t, Swap>(at));
    case PlyType::float32:
      return static_cast<To>(load_value<float, Swap>(at));
    case PlyType::float64:
      return static_cast<To>(load_value<double, Swap>(at));
  }
  return To{};
}

/// The data of a binary PLY file, value by value.
template <bool Swap>
class PlyBinary {
 public:
  static constexpr bool kText = false;
  static constexpr bool kSwap = Swap;

  explicit PlyBinary(std::span<const char> data) : at_(data.data()), end_(at_ + data.size()) {}

  size_t left() const { return static_cast<size_t>(end_ - at_); }
  const char* at() const { return at_; }
  void skip(size_t bytes) { at_ += bytes; }

  bool number(PlyType type, float& value) {
    if (left() < size_of(type)) return false;
    value = load_as<float, Swap>(type, at_);
    at_ += size_of(type);
    return true;
  }

  bool integer(PlyType type, int64_t& value) {
    if (left() < size_of(type)) return false;
    value = load_as<int64_t, Swap>(type, at_);
    at_ += size_of(type);
    return true;
  }

  Error truncated() const { return {"the file ends too early"}; }
  Error error(const std::string& what) const { return {what}; }

 private:
  const char* at_;
  const char* end_;
};

/// The data of a text PLY file, value by value; lines are counted for messages only.
class PlyText {
 public:
  static constexpr bool kText = true;

  PlyText(std::span<const char> data, size_t line)
      : at_(data.data()), end_(at_ + data.size()), line_(line) {}

  size_t left() const { return static_cast<size_t>(end_ - at_); }

  bool number(PlyType, float& value) {
    skip_space();
    return accept(scan_float(at_, end_, value));
  }

  bool integer(PlyType, int64_t& value) {
    skip_space();
    return accept(scan_integer(at_, end_, value));
  }

  Error truncated() const {
    return error(at_ == end_ ? "the file ends too early" : "expected a number");
  }
  Error error(const std::string& what) const {
    return Error{what}.in("line " + std::to_string(line_));
  }

 private:
  void skip_space() {
    while (at_ < end_ && is_space(*at_)) {
      if (*at_ == '\n') ++line_;
      ++at_;
    }
  }

  bool accept(const char* after) {
    if (after == nullptr || (after < end_ && !is_space(*after))) return false;
    at_ = after;
    return true;
  }

  const char* at_;
  const char* end_;
  size_t line_;
};

}  // namespace hyades::core
