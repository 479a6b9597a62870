#include "core/job/darkness.h"

#include <algorithm>
#include <variant>
#include <vector>

namespace hyades::core {
namespace {

bool any_emits(const std::vector<ObjectDesc>& objects) {
  return std::any_of(objects.begin(), objects.end(), [](const ObjectDesc& object) {
    return object.emit.has_value() || any_emits(object.children);
  });
}

}  // namespace

bool may_give_light(const Job& job) {
  const auto glows = [](const MediumDesc& medium) { return medium.emission.has_value(); };
  const auto emits = [](const GroupDesc& group) { return any_emits(group.objects); };
  const auto shines = [](const MaterialDesc& material) {
    const auto* principled = std::get_if<PrincipledDesc>(&material.kind);
    return principled != nullptr && principled->emits();
  };
  return !job.lights.empty() || job.environment ||
         std::any_of(job.media.begin(), job.media.end(), glows) ||
         std::any_of(job.materials.begin(), job.materials.end(), shines) ||
         any_emits(job.objects) || std::any_of(job.groups.begin(), job.groups.end(), emits);
}

}  // namespace hyades::core
