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

void write(FieldWriter& out, const ShellDensityDesc& shell) {
  out.enter("shell");
  out.put_file("image", shell.image);
  out.put("inner", shell.inner);
  out.put("outer", shell.outer);
  out.put("rotate_y", shell.rotate_y);
  out.put("low", shell.low);
  out.put("high", shell.high);
  out.put("tint", shell.tint);
  out.put("swirl", shell.swirl);
  out.put("scale", shell.scale);
  out.put("octaves", shell.octaves);
  out.put("time", shell.time);
  out.leave();
}

}  // namespace

void write_transform(FieldWriter& out, const TransformList& steps) {
  for (const TransformStep& step : steps) {
    out.enter("step");
    out.put("kind", static_cast<int32_t>(step.kind));
    out.put("vector", step.vector);
    out.put("angle", step.angle);
    out.put("quaternion", step.quaternion);
    out.put("matrix", step.matrix);
    out.leave();
  }
}

void write_density(FieldWriter& out, const DensityDesc& density) {
  out.enter("density");
  if (!density.vdb.empty()) {
    out.put_file("vdb", density.vdb);
    out.put("grid", density.grid);
    out.put("tint", density.tint);
    out.put("place", density.place);
    write_transform(out, density.transform);
    out.put("at", density.at);
  }
  if (density.noise) write(out, *density.noise);
  if (density.shell) write(out, *density.shell);
  out.put("march", density.march);
  out.leave();
}

void write_glow(FieldWriter& out, const GlowDesc& glow) {
  out.enter("glow");
  out.put("grid", glow.grid);
  out.put("temperature", glow.temperature);
  out.put("kelvin", glow.kelvin);
  out.leave();
}

}  // namespace hyades::core
