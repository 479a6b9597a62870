#include "import/pbrt/coefficients.h"

#include <optional>
#include <string>

#include "core/base/text.h"
#include "core/job/measured_media.h"

namespace hyades::core::pbrt {

Rgb coefficient(Context& context, ParameterReader& reader, const char* name, const Rgb& otherwise) {
  const Parameter* p = reader.find(name);
  if (p == nullptr) return otherwise;
  if (p->type == "texture") {
    context.report.note(p->place, "textures of coefficients are left out");
    return otherwise;
  }
  return color_of(context, *p, ColorUse::surface).value_or(otherwise);
}

namespace {

constexpr float kMillimetres = 1000.0F;  ///< of a metre

}  // namespace

std::optional<Coefficients> measured_coefficients(Context& context, const std::string& name,
                                                  const Place& place) {
  const MeasuredMedium* medium = find_measured_medium(name);
  if (medium == nullptr) {
    context.report.error(place, "there is no measured medium '" + name + "'" +
                                    did_you_mean(name, measured_medium_names()));
    return std::nullopt;
  }
  // Where g was measured it is part of what scatters: what counts with g = 0 is the rest.
  const Rgb reduced = medium->scattering * (Rgb(1.0F) - medium->g);
  return Coefficients{medium->absorption / kMillimetres, reduced / kMillimetres};
}

}  // namespace hyades::core::pbrt
