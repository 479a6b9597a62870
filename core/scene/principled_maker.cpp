#include "core/scene/principled_maker.h"

#include "core/materials/make_principled.h"

namespace hyades::core {

Result<MaterialPtr> principled_material(const PrincipledDesc& p, Appearance& looks) {
  PrincipledParams params;
  struct Color {
    const ColorInput& from;
    ColorParam& to;
  };
  for (const Color& each :
       {Color{p.base_color, params.base_color}, Color{p.specular_tint, params.specular_tint},
        Color{p.sheen_tint, params.sheen_tint}}) {
    auto made = looks.color(each.from);
    if (!made) return made.error();
    each.to = *made;
  }
  struct Number {
    const ScalarInput& from;
    ScalarParam& to;
  };
  for (const Number& each :
       {Number{p.metallic, params.metallic}, Number{p.roughness, params.roughness},
        Number{p.specular, params.specular}, Number{p.anisotropic, params.anisotropic},
        Number{p.anisotropic_rotation, params.anisotropic_rotation},
        Number{p.transmission, params.transmission},
        Number{p.diffuse_transmission, params.diffuse_transmission}, Number{p.coat, params.coat},
        Number{p.coat_roughness, params.coat_roughness}, Number{p.sheen, params.sheen},
        Number{p.sheen_roughness, params.sheen_roughness}}) {
    auto made = looks.scalar(each.from);
    if (!made) return made.error();
    each.to = *made;
  }
  if (p.roughness_along) {
    auto along = looks.scalar(*p.roughness_along);
    if (!along) return along.error();
    params.roughness_along = *along;
  }
  params.ior = p.ior.at(looks.time());
  params.coat_ior = p.coat_ior.at(looks.time());
  params.thin_walled = p.thin_walled;
  if (!p.multiple_scattering) params.facets = FacetScattering::single;
  params.scale_radiance = p.scale_radiance;
  params.subsurface = p.subsurface.has_value();
  return make_principled(params);
}

}  // namespace hyades::core
