#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::farm {

/// The channels to the coordinators of a farm: one to each address of a Peer. One of them leads,
/// and nothing answers at the others until they do. Whoever calls takes the current one, and says
/// when nothing has answered there. Thread-safe.
class Channels {
 public:
  /// One of them.
  struct Way {
    std::string address;
    std::shared_ptr<grpc::Channel> channel;
  };

  /// As connect() has it for each address; the first is the current one.
  static core::Result<std::shared_ptr<Channels>> open(const Peer& peer);
  /// At least one.
  explicit Channels(std::vector<Way> ways) : ways_(std::move(ways)) {}

  /// How many there are.
  size_t size() const { return ways_.size(); }
  /// The one to use now.
  Way current() const;
  /// Nothing answered at `way`: where it is the current one still, the next one is now. False when
  /// each has had its turn since something answered, or since the last time that it was false:
  /// then it is time to wait (Backoff) before another round. Else the current one is worth a try at
  /// once.
  bool failed(const Way& way);
  /// Something answered at the current one.
  void answered();

 private:
  const std::vector<Way> ways_;
  mutable core::Mutex mutex_;
  size_t current_ HYADES_GUARDED_BY(mutex_) = 0;
  size_t failed_ HYADES_GUARDED_BY(mutex_) = 0;  ///< of this round
};

}  // namespace hyades::farm
