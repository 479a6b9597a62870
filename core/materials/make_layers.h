#pragma once

#include "core/materials/make_material.h"

/// Materials that are made of others.
namespace hyades::core {

struct CoatParams {
  ScalarParam amount{1.0F, nullptr};  ///< how much of it is covered
  ScalarParam roughness;
  ColorParam color{Rgb(1.0F),
                   nullptr};  ///< of what light that goes straight in and out again keeps
  float ior = 1.5F;
};

/// Clear varnish over `base`: what it does not reflect goes on to `base` and comes back. On both
/// sides, but of bodies (leads_inside) on the outer one only.
MaterialPtr make_coat(MaterialPtr base, const CoatParams& params);

/// Fuzz of `color` over `base`, as of cloth (sheen.h).
MaterialPtr make_sheen(MaterialPtr base, const ColorParam& color, const ScalarParam& roughness);

/// `front` on the outer side, `back` on the inner one; neither lets light through.
MaterialPtr make_two_sided(MaterialPtr front, MaterialPtr back);

}  // namespace hyades::core
