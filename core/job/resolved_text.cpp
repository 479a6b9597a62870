#include "core/job/resolved_text.h"

#include "core/base/version.h"
#include "core/job/field_writer.h"
#include "core/job/layers.h"
#include "core/job/mesh_files.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {

namespace {

void write(FieldWriter& out, const FilmDesc& film) {
  out.enter("film");
  out.put("width", film.width);
  out.put("height", film.height);
  out.put("filter", static_cast<int32_t>(film.filter));
  out.put("filter_radius", film.filter_radius);
  out.leave();
}

/// Light paths bring light to all pixels that are rendered, and their number is that of these.
void write_region(FieldWriter& out, const FilmDesc& film) {
  const PixelRect region = render_window(film);
  out.enter("region");
  out.put("x0", region.x0);
  out.put("y0", region.y0);
  out.put("x1", region.x1);
  out.put("y1", region.y1);
  out.leave();
}

void write(FieldWriter& out, const SamplingDesc& sampling) {
  out.enter("sampling");
  out.put("samples", sampling.samples);
  out.put("seed", sampling.seed);
  out.put("sampler", static_cast<int32_t>(sampling.sampler));
  out.leave();
}

void write(FieldWriter& out, const IntegratorDesc& integrator) {
  out.enter("integrator");
  out.put("type", integrator.type);
  out.put("max_depth", integrator.max_depth);
  out.put("roulette_depth", integrator.roulette_depth);
  out.put("clamp", integrator.clamp);
  if (integrator.type == "bdpt") {
    out.put("light_vertices", integrator.light_vertices);
    out.put("camera_vertices", integrator.camera_vertices);
    out.put("mis", integrator.mis);
  }
  if (integrator.type == "mlt") {
    out.put("over", integrator.over);
    out.put("large_step", integrator.large_step);
  }
  out.leave();
}

void write(FieldWriter& out, const CameraDesc& camera) {
  out.enter("camera");
  out.put("type", camera.type);
  out.put("look_from", camera.look_from);
  out.put("look_at", camera.look_at);
  out.put("up", camera.up);
  out.put("fov", camera.fov);
  out.put("shift", camera.shift);
  out.put("height", camera.height);
  out.put("aperture_radius", camera.aperture_radius);
  if (camera.f_stop) out.put("f_stop", *camera.f_stop);
  out.put("aperture_blades", camera.aperture_blades);
  out.put("aperture_rotation", camera.aperture_rotation);
  if (camera.focus_distance) out.put("focus_distance", *camera.focus_distance);
  out.put("focus_object", camera.focus_object);
  out.leave();
}

void write(FieldWriter& out, const EmitDesc& emit) {
  out.enter("emit");
  out.put("color", emit.color);
  out.put("unit", static_cast<int32_t>(emit.unit));
  out.put("amount", emit.amount);
  out.put("two_sided", emit.two_sided);
  if (!emit.light_group.empty()) out.put("light_group", emit.light_group);
  out.leave();
}

/// `ahead`: frames look at the one after them.
void write(FieldWriter& out, const ObjectDesc& object, bool ahead) {
  out.enter("object");
  out.put("name", object.name);
  out.put("shape", object.shape);
  out.put_mesh_file("mesh", object.mesh, ahead);
  if (!object.part.empty()) out.put("part", object.part);
  out.put("instance_of", object.instance_of);
  if (!object.places.empty()) out.put_file("places", object.places);
  out.put("radius", object.radius);
  out.put("extent", object.extent);
  out.put("size", object.size);
  out.put("height", object.height);
  out.put("caps", object.caps);
  out.put("smooth", object.smooth);
  out.map("displacement", "", object.displacement);
  out.put("material", object.material);
  if (!object.interior.empty()) out.put("interior", object.interior);
  if (!object.exterior.empty()) out.put("exterior", object.exterior);
  if (object.priority != 0) out.put("priority", object.priority);
  for (const auto& [from, to] : object.overrides) {
    out.put("override", from);
    out.put("with", to);
  }
  out.put("transform", object.transform);
  out.put("at", object.at);
  if (object.emit) write(out, *object.emit);
  out.put("visible_to_camera", object.visible_to_camera);
  for (const ObjectDesc& child : object.children) write(out, child, ahead);
  out.leave();
}

void write(FieldWriter& out, const GroupDesc& group, bool ahead) {
  out.enter("group");
  out.put("name", group.name);
  for (const ObjectDesc& object : group.objects) write(out, object, ahead);
  out.leave();
}

std::vector<JobTime> shutter_moments(const Job& job, int32_t frame) {
  std::vector<JobTime> moments = {job.time_of(frame)};
  for (int i = 1; i < kMostShutterMoments && job.frames.shutter > 0.0F; ++i) {
    moments.push_back(job.time_of(frame, static_cast<float>(i) / (kMostShutterMoments - 1)));
  }
  if (needed_layers(job).motion) moments.push_back(job.time_of(frame + 1));
  return moments;
}

}  // namespace

std::string resolved_job_text(const Job& job, int32_t frame,
                              const std::vector<AssetRecord>& assets) {
  FieldWriter out(shutter_moments(job, frame), assets);
  out.put("renderer", kRendererRevision);
  out.put("frame", frame);
  out.put("shutter", job.frames.shutter);
  out.put("units", job.units);
  write(out, job.film);
  if (makes_splats(job.integrator)) write_region(out, job.film);
  write(out, job.sampling);
  write(out, job.integrator);
  write(out, job.camera);
  for (const TextureDesc& texture : job.textures) write_texture(out, texture);
  for (const MaterialDesc& material : job.materials) write_material(out, material);
  for (const MediumDesc& medium : job.media) write_medium(out, medium);
  const bool ahead = looks_at_next_frame(job);
  for (const GroupDesc& group : job.groups) write(out, group, ahead);
  for (const ObjectDesc& object : job.objects) write(out, object, ahead);
  for (const LightDesc& light : job.lights) write_light(out, light);
  out.map("environment", "", job.environment);
  if (!job.atmosphere.empty()) out.put("atmosphere", job.atmosphere);
  out.put_other_files(job.includes);
  return out.take();
}

}  // namespace hyades::core
