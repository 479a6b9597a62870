#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hyades::core {

/// Named things that refer to each other. Names that do not exist are ignored here.
class ReferenceGraph {
 public:
  explicit ReferenceGraph(const std::vector<std::string>& names);

  /// Thing `from` refers to `name` (once more).
  void add(size_t from, const std::string& name);
  /// Thing `i` counts `weight` by itself.
  void weigh(size_t i, uint64_t weight) { weights_[i] = weight; }

  /// The things that reach themselves, by index.
  std::vector<size_t> in_cycles() const;

  /// Weight of `name` with all that it refers to, as often as it does; capped at 2^40. Only where
  /// there are no cycles.
  uint64_t unfolded(const std::string& name);

 private:
  std::map<std::string, size_t> index_;
  std::vector<std::vector<size_t>> targets_;
  std::vector<uint64_t> weights_;
  std::vector<uint64_t> unfolded_;  ///< filled on first use
};

}  // namespace hyades::core
