#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hyades::core {

/// Named things that refer to each other. Names that do not exist are ignored here.
class ReferenceGraph {
 public:
  explicit ReferenceGraph(const std::vector<std::string>& names);

  /// Thing `from` refers to `name` (once more), a step of `length`.
  void add(size_t from, const std::string& name, int length = 1);
  /// Thing `i` counts `weight` by itself.
  void weigh(size_t i, uint64_t weight) { weights_[i] = weight; }

  /// The things that reach themselves, by index.
  std::vector<size_t> in_cycles() const;

  /// A thing from which a chain of references is longer than `length`. Only where there are no
  /// cycles.
  std::optional<size_t> first_longer_than(int length) const;

  /// Weight of `name` with all that it refers to, as often as it does; capped at 2^40. Only where
  /// there are no cycles.
  uint64_t unfolded(const std::string& name);

 private:
  struct Target {
    size_t index = 0;
    int length = 1;
  };

  /// Everything after what it refers to. Only where there are no cycles.
  std::vector<size_t> from_the_leaves() const;

  std::map<std::string, size_t> index_;
  std::vector<std::vector<Target>> targets_;
  std::vector<uint64_t> weights_;
  std::vector<uint64_t> unfolded_;  ///< filled on first use
};

}  // namespace hyades::core
