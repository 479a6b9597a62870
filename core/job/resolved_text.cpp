#include "core/job/resolved_text.h"

#include <set>
#include <string>

#include "core/base/version.h"
#include "core/job/field_writer.h"
#include "core/job/frame_files.h"
#include "core/job/layers.h"
#include "core/job/noise_threshold.h"
#include "core/job/old_lines.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {

namespace {

constexpr OldLine kOldFilmLines[] = {
    {"width"},
    {"height"},
    {"filter"},
    {"filter_radius", "00000000"},
};

constexpr OldLine kOldSamplingLines[] = {{"samples"}, {"seed"}, {"sampler"}};

constexpr OldLine kOldIntegratorLines[] = {
    {"max_depth"},      {"roulette_depth"},  {"clamp", "00000000"},
    {"light_vertices"}, {"camera_vertices"}, {"mis"},
    {"over"},           {"large_step"},
};

constexpr OldLine kOldCameraLines[] = {
    {"look_from"},
    {"look_at"},
    {"up"},
    {"fov", "42200000"},
    {"shift", "00000000,00000000"},
    {"height", "40a00000"},
    {"aperture_radius", "00000000"},
    {"f_stop"},
    {"aperture_blades", "0"},
    {"aperture_rotation", "00000000"},
    {"focus_distance"},
    {"focus_object", kNoText},
};

constexpr OldLine kOldEnvironmentLines[] = {
    {"image"},       {"sky.*"}, {"color"}, {"rotate_y"}, {"strength"}, {"visible_to_camera"},
    {"light_group"},
};

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
  FieldWriter out(shutter_moments(job, frame), assets, looks_at_next_frame(job));
  out.put("renderer", kRendererRevision);
  out.put("frame", frame);
  out.put("shutter", job.frames.shutter);
  out.put("units", job.units);
  write_desc(out, "film", job.film, kOldFilmLines);
  if (makes_splats(job.integrator)) write_region(out, job.film);
  write_desc(out, "sampling", job.sampling, kOldSamplingLines);
  if (job.sampling.noise > 0.0F) out.put("noise_exposure", shown_exposure(job));
  write_desc(out, "integrator", job.integrator, kOldIntegratorLines);
  write_desc(out, "render", job.render, {});
  write_desc(out, "camera", job.camera, kOldCameraLines);
  for (const TextureDesc& texture : job.textures) write_texture(out, texture);
  for (const MaterialDesc& material : job.materials) write_material(out, material);
  for (const MediumDesc& medium : job.media) write_medium(out, medium);
  for (const GroupDesc& group : job.groups) {
    out.enter("group");
    out.put("name", group.name);
    out.children("objects", group.objects);
    out.leave();
  }
  out.children("objects", job.objects);
  for (const LightDesc& light : job.lights) write_light(out, light);
  if (job.environment) write_desc(out, "environment", *job.environment, kOldEnvironmentLines);
  if (!job.atmosphere.empty()) out.put("atmosphere", job.atmosphere);
  // Other frames' files are no business of this one.
  std::set<std::string> others = sequence_files(job, out.sequences());
  others.insert(job.includes.begin(), job.includes.end());
  out.put_other_files(others);
  return out.take();
}

}  // namespace hyades::core
