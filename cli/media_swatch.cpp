#include "cli/media_swatch.h"

#include <cstddef>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include "cli/status_line.h"
#include "core/base/text.h"
#include "core/finish/frame_outputs.h"
#include "core/finish/picture.h"
#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::cli {

namespace {

/// The job in units of a ball's radius.
std::string swatch_job(const std::vector<KnownMedium>& media, const SwatchOptions& options) {
  constexpr float kApart = 2.4F;
  const auto count = static_cast<float>(media.size());
  const float width = kApart * count + 0.8F;
  std::string text = fmt::format(
      "hyades: 1\nname: swatch\nunits: {}\nfilm: {{size: [{}, 220]}}\nsampling: {{samples: {}}}\n"
      "integrator: {{type: path, max_depth: 4096, clamp: 3}}\n",
      0.5F * options.size, static_cast<int>(220.0F * width / 3.2F), options.samples);
  text +=
      "camera: {look_from: [0, 6.8, 19], look_at: [0, 0.86, 0], fov: 9}\n"
      "textures: {stripes: {type: checker, scale: [0, 0, 2.5], mapping: world, a: 0.16, b: 0.5}}\n"
      "materials:\n  table: {type: lambert, color: stripes}\n  air: {type: \"null\"}\n"
      "environment: {color: [0.75, 0.82, 0.95], strength: 0.6}\n";
  std::string bodies;
  text += "media:\n";
  for (size_t i = 0; i < media.size(); ++i) {
    const KnownMedium& m = media[i];
    // Given per metre; a unit of this job is the radius.
    const float unit = 0.5F * options.size;
    const auto list = [](const core::Rgb& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
    text += fmt::format("  m{}: {{absorption: {}, scattering: {}, g: {}, index: {}}}\n", i,
                        list(m.absorption * unit), list(m.scattering * unit), list(m.g), m.index);
    const float x = kApart * (static_cast<float>(i) - 0.5F * (count - 1.0F));
    bodies += fmt::format("  b{}: {{shape: sphere, at: [{}, 1.001, 0], interior: m{}}}\n", i, x, i);
  }
  text += "objects:\n  table: {shape: rectangle, size: [400, 400], material: table}\n" + bodies;
  text += fmt::format(
      "  window: {{shape: rectangle, size: [{}, 6], at: [-3, 8, 4], transform: [{{rotate_x: "
      "212}}], "
      "visible_to_camera: false, emit: {{color: [1, 0.95, 0.87], radiance: 5}}}}\n",
      6.0F + width);
  return text + "outputs: [{file: swatch.png, tone_map: filmic, exposure: 0.6, denoise: true}]\n";
}

}  // namespace

core::Status render_swatch(const std::vector<KnownMedium>& media, const SwatchOptions& options) {
  if (const auto format = core::picture_format(options.file); !format) {
    return format.error().in(options.file);
  }
  const auto assets = core::make_file_resolver(".");
  core::Diagnostics diagnostics;
  core::Job job = core::parse_job(swatch_job(media, options), "swatch", *assets, diagnostics);
  if (!diagnostics.empty()) return diagnostics.to_error();
  core::SceneCache cache(*assets);
  auto scene = core::build_scene(job, 1, cache);
  if (!scene) return scene.error();
  const core::FrameRenderer renderer(*scene, job, 1, core::needed_layers(job));
  core::RenderFrameOptions how;
  how.threads = options.threads;
  ShareDone done(options.quiet);
  how.progress = [&](double share) { done.show(share); };
  const auto frame =
      core::render_frame(renderer, core::render_window(job.film), job.sampling.samples, 1, how);
  done.clear();
  const std::filesystem::path path(options.file);
  job.outputs.front().file = path.filename().string();
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  core::FilmInfo info;
  info.job_name = job.name;
  info.samples = job.sampling.samples;
  const auto written = core::write_outputs(job.outputs, folder, info, frame.film);
  return written ? core::Status{} : written.error();
}

}  // namespace hyades::cli
