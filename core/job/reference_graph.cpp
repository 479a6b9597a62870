#include "core/job/reference_graph.h"

#include <algorithm>
#include <cstddef>

namespace hyades::core {

namespace {

constexpr uint64_t kCap = uint64_t{1} << 40;

using Edges = std::vector<std::vector<size_t>>;

/// Marks everything that can be taken away one by one, each when nothing of `in` is left before it.
void peel(const Edges& in, const Edges& out, std::vector<bool>& gone) {
  std::vector<size_t> left(in.size(), 0);
  std::vector<size_t> ready;
  for (size_t i = 0; i < in.size(); ++i) {
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
}

}  // namespace

ReferenceGraph::ReferenceGraph(const std::vector<std::string>& names)
    : targets_(names.size()), weights_(names.size(), 0) {
  for (size_t i = 0; i < names.size(); ++i) index_[names[i]] = i;
}

void ReferenceGraph::add(size_t from, const std::string& name, int length) {
  const auto found = index_.find(name);
  if (found != index_.end()) targets_[from].push_back({found->second, length});
}

std::vector<size_t> ReferenceGraph::in_cycles() const {
  // Kahn's algorithm from both ends: what neither removes lies on a cycle or between two.
  Edges sources(targets_.size());
  Edges targets(targets_.size());
  for (size_t i = 0; i < targets_.size(); ++i) {
    for (const Target& target : targets_[i]) {
      targets[i].push_back(target.index);
      sources[target.index].push_back(i);
    }
  }
  std::vector<bool> gone(targets_.size(), false);
  peel(sources, targets, gone);
  peel(targets, sources, gone);
  std::vector<size_t> result;
  for (size_t i = 0; i < gone.size(); ++i) {
    if (!gone[i]) result.push_back(i);
  }
  return result;
}

std::vector<size_t> ReferenceGraph::from_the_leaves() const {
  // Depth first with a list instead of recursion: chains may be as long as the text allows.
  enum class State : uint8_t { untouched, open, done };
  std::vector<State> state(targets_.size(), State::untouched);
  std::vector<size_t> order;
  for (size_t start = 0; start < targets_.size(); ++start) {
    std::vector<size_t> stack = {start};
    while (!stack.empty()) {
      const size_t i = stack.back();
      if (state[i] == State::untouched) {
        state[i] = State::open;
        for (const Target& target : targets_[i]) {
          if (state[target.index] == State::untouched) stack.push_back(target.index);
        }
        continue;
      }
      stack.pop_back();
      if (state[i] == State::open) order.push_back(i);
      state[i] = State::done;
    }
  }
  return order;
}

std::optional<size_t> ReferenceGraph::first_longer_than(int length) const {
  std::vector<int> longest(targets_.size(), 0);
  for (const size_t i : from_the_leaves()) {
    for (const Target& target : targets_[i]) {
      longest[i] = std::max(longest[i], longest[target.index] + target.length);
    }
    if (longest[i] > length) return i;
  }
  return std::nullopt;
}

uint64_t ReferenceGraph::unfolded(const std::string& name) {
  const auto found = index_.find(name);
  if (found == index_.end()) return 0;
  if (unfolded_.size() != targets_.size()) {
    unfolded_.assign(targets_.size(), 0);
    for (const size_t i : from_the_leaves()) {
      unfolded_[i] = weights_[i];
      for (const Target& target : targets_[i]) {
        unfolded_[i] = std::min(kCap, unfolded_[i] + unfolded_[target.index]);
      }
    }
  }
  return unfolded_[found->second];
}

}  // namespace hyades::core
