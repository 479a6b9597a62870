#include "core/job/density_text.h"

namespace hyades::core {

namespace {

void write(FieldWriter& out, const NoiseDensityDesc& noise) {
  out.enter("noise");
  out.put("scale", noise.scale);
  out.put("offset", noise.offset);
  out.put("octaves", noise.octaves);
  out.put("lacunarity", noise.lacunarity);
  out.put("gain", noise.gain);
  out.put("time", noise.time);
  out.put("low", noise.low);
  out.put("high", noise.high);
  out.put("fade", noise.fade);
  out.leave();
}

}  // namespace

void write_density(FieldWriter& out, const DensityDesc& density) {
  out.enter("density");
  if (density.noise) write(out, *density.noise);
  out.leave();
}

}  // namespace hyades::core
