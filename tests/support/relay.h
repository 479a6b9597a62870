#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "core/base/descriptor.h"

namespace hyades::test {

/// A port of this machine that passes connections on to another one, until it is frozen: then it
/// takes connections and bytes as a process does that is stopped, and nothing ever answers.
class Relay {
 public:
  /// `there`: "127.0.0.1:PORT"; empty: it is frozen from the beginning.
  explicit Relay(const std::string& there = {});
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// "127.0.0.1:PORT".
  std::string address() const;
  void freeze() { frozen_ = true; }

 private:
  /// A connection, from each of its ends to the other.
  struct Pair {
    core::Descriptor ends[2];
  };

  void run();
  void take();

  const int there_;  ///< port
  std::atomic<bool> frozen_;
  std::atomic<bool> end_{false};
  core::Descriptor listening_;
  std::vector<Pair> pairs_;
  std::thread thread_;
};

}  // namespace hyades::test
