#include "coordinator/access/trusted_neighbours.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {
namespace {

constexpr size_t kMostTokensOfOne = 4;

}  // namespace

void TrustedNeighbours::trust(const std::string& neighbourhood, const std::string& token_id,
                              Time now) {
  OfToken& own = tokens_[token_id];
  if (own.now.size() >= most_ || now - own.since >= time_) {
    for (const std::string& old : std::exchange(own.before, std::exchange(own.now, {}))) {
      if (!own.before.contains(old)) forget(old, token_id);
    }
    own.since = now;
  }
  own.now.insert(neighbourhood);
  std::vector<std::string>& shown = tokens_of_[neighbourhood];
  std::erase(shown, token_id);
  shown.push_back(token_id);
  if (shown.size() <= kMostTokensOfOne) return;
  const auto places_of = [&](const std::string& token) {
    const OfToken& of = tokens_.at(token);
    return of.now.size() + of.before.size();
  };
  shown.erase(std::max_element(shown.begin(), shown.end() - 1, [&](const auto& a, const auto& b) {
    return places_of(a) < places_of(b);
  }));
}

const std::vector<std::string>& TrustedNeighbours::tokens_of(
    const std::string& neighbourhood) const {
  static const std::vector<std::string> none;
  const auto found = tokens_of_.find(neighbourhood);
  return found == tokens_of_.end() ? none : found->second;
}

void TrustedNeighbours::forget(const std::string& neighbourhood, const std::string& token_id) {
  const auto found = tokens_of_.find(neighbourhood);
  if (found == tokens_of_.end()) return;
  std::erase(found->second, token_id);
  if (found->second.empty()) tokens_of_.erase(found);
}

}  // namespace hyades::coordinator
