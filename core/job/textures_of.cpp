#include "core/job/textures_of.h"

namespace hyades::core {

std::vector<std::string> textures_of(const MaterialDesc& m) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty()) names.push_back(name);
  };
  for (const ColorInput* input : {&m.color, &m.edge, &m.transmitted}) add(input->texture);
  for (const ScalarInput* input :
       {&m.roughness, &m.reflectiveness, &m.glossiness, &m.amount, &m.opacity}) {
    add(input->texture);
  }
  if (m.bump) add(m.bump->texture);
  if (m.normal_map) {
    add(m.normal_map->texture);
    add(m.normal_map->strength.texture);
  }
  if (m.principled) {
    const PrincipledDesc& p = *m.principled;
    for (const ColorInput* input :
         {&p.base_color, &p.specular_tint, &p.sheen_tint, &p.emission_color})
      add(input->texture);
    for (const ScalarInput* input :
         {&p.metallic, &p.specular, &p.anisotropic, &p.anisotropic_rotation, &p.transmission,
          &p.diffuse_transmission, &p.coat, &p.coat_roughness, &p.sheen, &p.sheen_roughness}) {
      add(input->texture);
    }
    if (p.roughness_along) add(p.roughness_along->texture);
  }
  return names;
}

}  // namespace hyades::core
