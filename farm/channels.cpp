#include "farm/channels.h"

namespace hyades::farm {

core::Result<std::shared_ptr<Channels>> Channels::open(const Peer& peer) {
  const std::vector<std::string> addresses = split_addresses(peer.address);
  std::vector<Way> ways;
  for (const std::string& address : addresses) {
    Peer one = peer;
    one.address = address;
    auto channel = connect(one, addresses.size() > 1 ? Notices::soon : Notices::patiently);
    if (!channel) return channel.error();
    ways.push_back({address, std::move(*channel)});
  }
  return std::make_shared<Channels>(std::move(ways));
}

Channels::Way Channels::current() const {
  const core::MutexLock lock(mutex_);
  return ways_[current_];
}

bool Channels::failed(const Way& way) {
  const core::MutexLock lock(mutex_);
  if (ways_[current_].channel != way.channel) return true;
  current_ = (current_ + 1) % ways_.size();
  failed_ = (failed_ + 1) % ways_.size();
  return failed_ != 0;
}

void Channels::answered() {
  const core::MutexLock lock(mutex_);
  failed_ = 0;
}

}  // namespace hyades::farm
