#include "core/job/read_preset.h"

#include <string>

#include "core/job/measured_media.h"

namespace hyades::core {

namespace {

/// What a preset brings.
constexpr const char* kBrought[] = {
    "absorption", "scattering", "albedo", "mean_free_path", "density", "phase", "g", "g2", "blend"};

}  // namespace

void read_preset(MapReader& reader, MediumDesc& medium) {
  std::string name;
  reader.text("preset", name, "the name of a measured material");
  if (name.empty()) return;
  const YamlNode& node = *reader.find("preset");
  const MeasuredMedium* const measured = find_measured_medium(name);
  if (measured == nullptr) {
    reader.mismatch("preset", node,
                    "the name of a measured material ('hyades media' lists them)" +
                        did_you_mean(name, measured_medium_names()));
    return;
  }
  for (const char* key : kBrought) {
    if (!reader.has(key) || (medium.varying && key == std::string_view("density"))) continue;
    reader.complain(reader.find(key)->where, reader.what() + " has both preset and " + key +
                                                 ", expected a preset with scale, emission or "
                                                 "index alone");
  }
  const float units = reader.context().job.units;
  medium.absorption = Animated<Rgb>(measured->absorption * units);
  medium.scattering = Animated<Rgb>(measured->scattering * units);
  medium.g = Animated<Rgb>(measured->g);
  medium.index = measured->index;
}

void read_index(MapReader& reader, MediumDesc& medium) {
  const bool given = reader.has("index") || reader.listing();
  Animated<float> index(1.0F);
  reader.animated("index", index, {0.01, 100.0});
  if (given) medium.index = index;
}

}  // namespace hyades::core
