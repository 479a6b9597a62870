#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Variants of structs with a `kTraits.type`, the name that jobs have for them.
namespace hyades::core {

template <class Variant>
struct KindsOf;

template <class... Kinds>
struct KindsOf<std::variant<Kinds...>> {
  using Variant = std::variant<Kinds...>;

  /// The names, in the order of the alternatives.
  static const std::vector<std::string>& names() {
    static const std::vector<std::string> all = {Kinds::kTraits.type...};
    return all;
  }

  /// The name of what `kind` holds.
  static const std::string& name(const Variant& kind) { return names()[kind.index()]; }

  /// The alternative at `index` with its defaults.
  static Variant make(size_t index) {
    static constexpr std::array<Variant (*)(), sizeof...(Kinds)> kMakers = {
        [] { return Variant(Kinds{}); }...};
    return kMakers[index]();
  }
};

}  // namespace hyades::core
