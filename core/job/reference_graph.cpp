#include "core/job/reference_graph.h"

#include <algorithm>

namespace hyades::core {

namespace {

constexpr uint64_t kCap = uint64_t{1} << 40;

}  // namespace

ReferenceGraph::ReferenceGraph(const std::vector<std::string>& names)
    : targets_(names.size()), weights_(names.size(), 0) {
  for (size_t i = 0; i < names.size(); ++i) index_[names[i]] = i;
}

void ReferenceGraph::add(size_t from, const std::string& name) {
  const auto found = index_.find(name);
  if (found != index_.end()) targets_[from].push_back(found->second);
}

std::vector<size_t> ReferenceGraph::in_cycles() const {
  // Kahn's algorithm from both ends: what neither start removes lies on a cycle or between two.
  const size_t count = targets_.size();
  std::vector<std::vector<size_t>> sources(count);
  for (size_t i = 0; i < count; ++i) {
    for (const size_t t : targets_[i]) sources[t].push_back(i);
  }
  std::vector<bool> gone(count, false);
  const auto peel = [&](const std::vector<std::vector<size_t>>& in,
                        const std::vector<std::vector<size_t>>& out) {
    std::vector<size_t> left(count, 0);
    std::vector<size_t> ready;
    for (size_t i = 0; i < count; ++i) {
      for (const size_t s : in[i]) left[i] += gone[s] ? 0 : 1;
      if (!gone[i] && left[i] == 0) ready.push_back(i);
    }
    while (!ready.empty()) {
      const size_t i = ready.back();
      ready.pop_back();
      gone[i] = true;
      for (const size_t t : out[i]) {
        if (!gone[t] && --left[t] == 0) ready.push_back(t);
      }
    }
  };
  peel(sources, targets_);
  peel(targets_, sources);
  std::vector<size_t> result;
  for (size_t i = 0; i < count; ++i) {
    if (!gone[i]) result.push_back(i);
  }
  return result;
}

uint64_t ReferenceGraph::unfolded(const std::string& name) {
  const auto found = index_.find(name);
  if (found == index_.end()) return 0;
  const size_t count = targets_.size();
  if (unfolded_.size() != count) {
    // Depth first with a list: chains of groups may be as long as the text allows.
    unfolded_.assign(count, 0);
    std::vector<uint8_t> state(count, 0);
    for (size_t start = 0; start < count; ++start) {
      std::vector<size_t> stack = {start};
      while (!stack.empty()) {
        const size_t i = stack.back();
        if (state[i] == 0) {
          state[i] = 1;
          for (const size_t t : targets_[i]) {
            if (state[t] == 0) stack.push_back(t);
          }
          continue;
        }
        stack.pop_back();
        if (state[i] == 2) continue;
        state[i] = 2;
        unfolded_[i] = weights_[i];
        for (const size_t t : targets_[i]) {
          unfolded_[i] = std::min(kCap, unfolded_[i] + unfolded_[t]);
        }
      }
    }
  }
  return unfolded_[found->second];
}

}  // namespace hyades::core
