#include "coordinator/controller/owner_connections.h"

#include <utility>

namespace hyades::coordinator {

OwnerConnections::Entry::Entry(OwnerConnections& all, std::string owner)
    : all_(all), owner_(std::move(owner)) {}

OwnerConnections::Entry::~Entry() { all_.leave(owner_); }

std::unique_ptr<OwnerConnections::Entry> OwnerConnections::enter(const std::string& owner,
                                                                 grpc::Status& refused) {
  const core::MutexLock lock(mutex_);
  if (!owner.empty()) {
    const auto open = open_.find(owner);
    refused = quotas_.may_connect(owner, open == open_.end() ? 0 : open->second);
    if (!refused.ok()) return nullptr;
  }
  ++open_[owner];
  return std::make_unique<Entry>(*this, owner);
}

void OwnerConnections::leave(const std::string& owner) {
  const core::MutexLock lock(mutex_);
  const auto open = open_.find(owner);
  if (--open->second == 0) open_.erase(open);
}

}  // namespace hyades::coordinator
