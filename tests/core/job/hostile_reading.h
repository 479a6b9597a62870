#pragma once

#include <gtest/gtest.h>

#include <ctime>
#include <string>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

/// Texts that mean harm, and texts that are merely broken: refused with a complaint, in bounded
/// time and memory.
namespace hyades::core {

inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct HostileReading {
  Diagnostics diagnostics;
  double seconds = 0.0;  ///< of processor time: the machine may be busy
  std::string first() const {
    return diagnostics.empty() ? "" : diagnostics.list().front().to_string();
  }
};

inline HostileReading read_hostile(const std::string& text, MemoryAssets assets = {}) {
  HostileReading reading;
  const double begin = processor_seconds();
  parse_job(text, "job.yaml", assets, reading.diagnostics);
  reading.seconds = processor_seconds() - begin;
  return reading;
}

/// Generous: sanitizers are slow. What is guarded against takes minutes or hours.
inline constexpr double kPatience = 20.0;

inline void expect_refused(const std::string& text, const std::string& complaint) {
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.first(), complaint);
  EXPECT_LT(reading.seconds, kPatience);
}

inline std::string repeated(const std::string& piece, size_t times) {
  std::string all;
  all.reserve(piece.size() * times);
  for (size_t i = 0; i < times; ++i) all += piece;
  return all;
}

}  // namespace hyades::core
