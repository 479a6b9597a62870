#include "farm/fair_shares.h"

#include <algorithm>
#include <cmath>

namespace hyades::farm {
namespace {

constexpr double kHalfLife = 600.0;  // seconds
constexpr size_t kMostKnown = 1000;

}  // namespace

double FairShares::now_worth(const Share& share, Time now) {
  const std::chrono::duration<double> ago = now - share.at;
  return share.amount * std::exp2(-std::max(ago.count(), 0.0) / kHalfLife);
}

void FairShares::use(const std::string& who, double amount, Time now) {
  Share& share = shares_[who];
  share = {now_worth(share, now) + amount, now};
  if (shares_.size() <= kMostKnown) return;
  shares_.erase(
      std::min_element(shares_.begin(), shares_.end(), [now](const auto& a, const auto& b) {
        return now_worth(a.second, now) < now_worth(b.second, now);
      }));
}

double FairShares::used(const std::string& who, Time now) const {
  const auto known = shares_.find(who);
  return known == shares_.end() ? 0.0 : now_worth(known->second, now);
}

}  // namespace hyades::farm
