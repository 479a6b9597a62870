#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/job/visibility_desc.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// The lists of objects that lights are linked to: each different one gets a number, and each
/// object a bit for every list that it is in. List 0 is that of all objects.
class LinkingLists {
 public:
  /// Of `scene`, which has its objects and outlives this.
  explicit LinkingLists(const Scene& scene)
      : objects_(&scene.objects), bits_(scene.objects.size() + 1, 1) {
    numbers_.emplace(Members(bits_.size(), true), 0);
  }

  /// The number of a light's list. Errors: a name that no object has; more than 63 lists.
  Result<uint8_t> number_of(const std::optional<LinkingDesc>& linking);

  /// How many objects there were.
  size_t objects() const { return bits_.size() - 1; }
  /// The lists that object `index` is in.
  ListBits of(size_t index) const { return bits_[index]; }
  /// The lists that are without an `include`: those of what has no name.
  ListBits of_rest() const { return bits_.back(); }

 private:
  using Members = std::vector<bool>;  ///< one for each object, and for what has no name

  Result<uint8_t> number_of_new(const LinkingDesc& linking);
  Result<Members> members_of(const LinkingDesc& linking) const;

  const std::vector<SceneObject>* objects_;
  std::map<Members, uint8_t> numbers_;
  using Names = std::optional<std::vector<std::string>>;
  std::map<std::pair<Names, Names>, uint8_t> known_;  ///< numbers by `include` and `exclude`
  std::vector<ListBits> bits_;
};

}  // namespace hyades::core
