#include "coordinator/access/trusted_neighbours.h"

#include <utility>

namespace hyades::coordinator {

void TrustedNeighbours::trust(const std::string& neighbourhood, const std::string& token_id,
                              Time now) {
  OfToken& own = tokens_[token_id];
  if (own.now.size() >= most_ || now - own.since >= time_) {
    for (const std::string& old : std::exchange(own.before, std::exchange(own.now, {}))) {
      const auto found = token_of_.find(old);
      const bool is_ours = found != token_of_.end() && found->second == token_id;
      if (is_ours && !own.before.contains(old)) token_of_.erase(found);
    }
    own.since = now;
  }
  own.now.insert(neighbourhood);
  token_of_.insert_or_assign(neighbourhood, token_id);
}

const std::string* TrustedNeighbours::token_of(const std::string& neighbourhood) const {
  const auto found = token_of_.find(neighbourhood);
  return found == token_of_.end() ? nullptr : &found->second;
}

}  // namespace hyades::coordinator
