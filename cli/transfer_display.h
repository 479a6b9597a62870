#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "cli/status_line.h"

namespace hyades::cli {

/// How far bytes are on their way.
struct Transfer {
  std::string what;             ///< "uploading"
  std::string file;             ///< the one that is on its way: "2 of 7", or its name
  uint64_t moved = 0;           ///< bytes
  uint64_t total = 0;           ///< bytes; 0: nobody knows
  double bytes_per_second = 0;  ///< 0: cannot be told yet
};

/// In one line, with a bar where `bar` and the total is known: "uploading  ███░░  60 %  file 2 of
/// 7  1.2 GiB of 2.0 GiB  48.1 MiB/s  17 s left".
std::string transfer_line(const Transfer& transfer, bool bar);

/// Shows how far a transfer is: one line that is redrawn on a terminal, plain lines every ten
/// seconds elsewhere, nothing where `quiet`. Writes to standard error.
class TransferDisplay {
 public:
  using Clock = StatusLine::Clock;

  TransferDisplay(std::string what, bool quiet,
                  std::function<Clock::time_point()> now = Clock::now);

  /// So many bytes more are to come.
  void expect(uint64_t bytes) { transfer_.total += bytes; }
  /// So many of them need not come: they are here.
  void spare(uint64_t bytes) { transfer_.total -= std::min(bytes, transfer_.total); }
  void begin_file(std::string file) { transfer_.file = std::move(file); }
  void moved(uint64_t bytes);
  /// Removes the redrawn line, so that other text can be written.
  void clear() { line_.clear(); }

  const Transfer& transfer() const { return transfer_; }

 private:
  void note_rate(Clock::time_point now);

  bool quiet_;
  std::function<Clock::time_point()> now_;
  Transfer transfer_;
  StatusLine line_;
  std::deque<std::pair<Clock::time_point, uint64_t>> lately_;  ///< bytes moved until then
};

}  // namespace hyades::cli
