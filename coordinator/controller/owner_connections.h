#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/owner_quotas.h"
#include "core/base/mutex.h"

namespace hyades::coordinator {

/// How many streams each owner has open. Thread-safe.
class OwnerConnections {
 public:
  /// One open stream, as long as this lives.
  class Entry {
   public:
    Entry(OwnerConnections& all, std::string owner);
    ~Entry();
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    OwnerConnections& all_;
    const std::string owner_;
  };

  /// `quotas` outlive it, and it outlives its entries.
  explicit OwnerConnections(const OwnerQuotas& quotas) : quotas_(quotas) {}

  /// Counts a stream of the owner's; null, with the reason in `refused`, where he has as many as he
  /// may. Who has no name (the farm asks for no token, or it is one for all) has as many as he
  /// likes.
  std::unique_ptr<Entry> enter(const std::string& owner, grpc::Status& refused);

 private:
  void leave(const std::string& owner);

  const OwnerQuotas& quotas_;
  core::Mutex mutex_;
  std::map<std::string, uint64_t> open_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
