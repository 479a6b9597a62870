#include <string>
#include <string_view>

#include "core/job/map_reader.h"
#include "core/job/measured_media.h"

namespace hyades::core {

namespace {

/// What a preset brings.
constexpr const char* kBrought[] = {
    "absorption", "scattering", "albedo", "mean_free_path", "density", "phase", "g", "g2", "blend"};

}  // namespace

void MapReader::preset(std::string_view key, MediumDesc& medium) {
  std::string name;
  text(key, name, "the name of a measured material");
  if (listing()) tell(key, {.takes = "choice", .names = measured_medium_names()});
  if (name.empty()) return;
  const MeasuredMedium* const measured = find_measured_medium(name);
  if (measured == nullptr) {
    mismatch(key, *find(key),
             "the name of a measured material ('hyades media' lists them)" +
                 did_you_mean(name, measured_medium_names()));
    return;
  }
  for (const char* brought : kBrought) {
    if (!has(brought) || (medium.varying && brought == std::string_view("density"))) continue;
    complain(where_of(brought), what_ + " has both preset and " + brought +
                                    ", expected a preset with scale, emission or index alone");
  }
  const float units = context_.job.units;
  medium.absorption = Animated<Rgb>(measured->absorption * units);
  medium.scattering = Animated<Rgb>(measured->scattering * units);
  medium.g = Animated<Rgb>(measured->g);
  medium.index = measured->index;
}

}  // namespace hyades::core
