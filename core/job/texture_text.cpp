#include "core/job/resolved_parts.h"

namespace hyades::core {

namespace {

void write(FieldWriter& out, const TextureImage& image) {
  out.enter("image");
  out.put_file("file", image.file);
  out.put("color_space", image.color_space);
  out.put("wrap", image.wrap);
  if (image.wrap_v != image.wrap) out.put("wrap_v", image.wrap_v);
  out.put("filter", image.filter);
  out.leave();
}

void write(FieldWriter& out, const TextureMapping& mapping) {
  out.enter("mapping");
  out.put("type", mapping.type);
  out.put("space", mapping.space);
  out.put("transform", mapping.transform);
  out.put("blend", mapping.blend);
  out.put("scale", mapping.scale);
  out.put("offset", mapping.offset);
  out.leave();
}

void write(FieldWriter& out, const TextureNoise& noise) {
  out.enter("noise");
  out.put("octaves", noise.octaves);
  out.put("lacunarity", noise.lacunarity);
  out.put("gain", noise.gain);
  if (noise.time) out.put("time", *noise.time);
  out.put("distortion", noise.distortion);
  out.leave();
}

void write(FieldWriter& out, const TextureRemap& remap) {
  out.enter("remap");
  out.put("low", remap.low);
  out.put("high", remap.high);
  out.put("to_low", remap.to_low);
  out.put("to_high", remap.to_high);
  out.put("ends", remap.ends);
  out.leave();
}

}  // namespace

void write_texture(FieldWriter& out, const TextureDesc& texture) {
  out.enter("texture");
  out.put("name", texture.name);
  out.put("type", texture.type);
  out.put("a", texture.a);
  out.put("b", texture.b);
  out.put("amount", texture.amount);
  write(out, texture.image);
  write(out, texture.mapping);
  write(out, texture.noise);
  out.put("metric", texture.cells.metric);
  out.put("feature", texture.cells.feature);
  out.put("jitter", texture.cells.jitter);
  out.put("width", texture.lines.width);
  out.put("shift", texture.lines.shift);
  out.put("line_softness", texture.lines.softness);
  out.put("shape", texture.shape);
  write(out, texture.remap);
  for (const TextureStop& stop : texture.stops) {
    out.put("stop.at", stop.at);
    out.put("stop.color", stop.color);
  }
  out.put("between", texture.between);
  out.put("exponent", texture.exponent);
  out.put("level", texture.level);
  out.put("softness", texture.softness);
  out.put("hue", texture.hue);
  out.put("saturation", texture.saturation);
  out.put("value", texture.value);
  out.put("channel", texture.channel);
  out.leave();
}

}  // namespace hyades::core
