#include "tests/import/rendered_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "core/finish/picture.h"
#include "core/image/write_image.h"
#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/job/yaml_build.h"
#include "core/job/yaml_writer.h"
#include "core/scene/build_scene.h"
#include "tests/support/moments.h"

namespace hyades::test {
namespace {

/// The files that a source makes, as "made/...", besides those of a folder.
class MadeFiles : public core::AssetResolver {
 public:
  MadeFiles(const core::SceneSource& source, const std::string& folder)
      : source_(source), folder_(core::make_file_resolver(folder)) {}

  core::Result<core::Bytes> open(const std::string& reference, const std::string& from) override {
    if (reference.starts_with("made/")) return source_.made_file(reference.substr(5));
    return folder_->open(reference, from);
  }

 private:
  const core::SceneSource& source_;
  std::unique_ptr<core::AssetResolver> folder_;
};

std::string job_text(const core::YamlNode& sections, const std::string& own, int samples) {
  core::Diagnostics diagnostics;
  const core::YamlPtr more = core::parse_yaml(own, "test.yaml", diagnostics);
  if (!diagnostics.empty()) throw std::runtime_error(diagnostics.to_string());
  core::YamlMap job{{"hyades", core::yaml_integer(1)}};
  job.put("sampling", core::YamlMap{{"samples", core::yaml_integer(samples)}});
  for (const core::YamlEntry& entry : sections.map) {
    const bool replaced = entry.key == "sampling" || more->find(entry.key) != nullptr;
    if (!replaced) job.put(entry.key, entry.value);
  }
  for (const core::YamlEntry& entry : more->map) job.put(entry.key, entry.value);
  return core::write_yaml(*job.node());
}

void leave_picture(const core::Image& image, const std::string& name) {
  const char* folder = std::getenv("HYADES_TEST_PICTURES");
  if (folder == nullptr) return;
  const auto shown = core::display_picture(image, core::ToneCurve::srgb, 0.0F, false);
  if (!shown) throw std::runtime_error(shown.error().message);
  const core::Status written = core::write_png(std::string(folder) + "/" + name + ".png", *shown);
  if (!written) throw std::runtime_error(written.error().message);
}

}  // namespace

core::Rgb ScenePicture::at(int x, int y) const {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

core::Rgb ScenePicture::mean(int x0, int y0, int x1, int y1) const {
  core::Vec3d sum(0.0);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) sum += core::Vec3d(at(x, y));
  }
  return core::Rgb(sum / static_cast<double>((x1 - x0) * (y1 - y0)));
}

std::string Window::yaml() const {
  return fmt::format(
      "film: {{size: [{}, {}]}}\n"
      "camera: {{type: orthographic, look_from: [{}, {}, {}], look_at: [{}, {}, {}], height: "
      "{}}}\n",
      pixels_across, pixels_high, x, y, from, x, y, from - 1.0F, height);
}

namespace {

/// Pixels of a square around a place of a window.
core::PixelRect pixels_of(const Window& window, float at_x, float at_y, float half) {
  const float scale = static_cast<float>(window.pixels_high) / window.height;
  const float column = 0.5F * static_cast<float>(window.pixels_across) + (at_x - window.x) * scale;
  const float row = 0.5F * static_cast<float>(window.pixels_high) - (at_y - window.y) * scale;
  const float reach = std::max(half * scale, 0.5F);
  return {static_cast<int>(column - reach), static_cast<int>(row - reach),
          static_cast<int>(column + reach), static_cast<int>(row + reach)};
}

}  // namespace

core::Rgb Window::mean(const ScenePicture& picture, float at_x, float at_y, float half) const {
  const core::PixelRect r = pixels_of(*this, at_x, at_y, half);
  return picture.mean(r.x0, r.y0, r.x1, r.y1);
}

double Window::contrast(const ScenePicture& picture, float at_x, float at_y, float half) const {
  const core::PixelRect r = pixels_of(*this, at_x, at_y, half);
  Moments moments;
  for (int row = r.y0; row < r.y1; ++row) {
    for (int column = r.x0; column < r.x1; ++column) {
      moments.add(static_cast<double>(core::luminance(picture.at(column, row))));
    }
  }
  return moments.variance() / (moments.mean() * moments.mean());
}

ScenePicture render_scene(const core::SceneSource& source, const SceneView& view,
                          const std::string& folder, const std::string& name) {
  core::SceneRequest request;
  request.animation = view.animation;
  request.loop = view.loop;
  request.fps = view.fps;
  request.made = "made/";
  auto sections = source.sections(request);
  if (!sections) throw std::runtime_error(sections.error().message);
  ScenePicture picture;
  picture.notes = sections->notes;
  picture.job = job_text(*sections->sections, view.yaml, view.samples);
  for (const auto& [from, to] : view.edits) {
    const size_t at = picture.job.find(from);
    if (at == std::string::npos) throw std::runtime_error("no '" + from + "' in\n" + picture.job);
    picture.job.replace(at, from.size(), to);
  }
  MadeFiles files(source, folder);
  core::Diagnostics diagnostics;
  const core::Job job = core::parse_job(picture.job, "scene.yaml", files, diagnostics);
  if (!diagnostics.empty()) throw std::runtime_error(diagnostics.to_string());
  core::SceneCache cache(files);
  const auto scene = core::build_scene(job, view.frame, cache);
  if (!scene) throw std::runtime_error(scene.error().message);
  core::LayerSet layers;
  layers.splats = core::makes_splats(job.integrator);
  const core::FrameRenderer renderer(*scene, job, view.frame, layers);
  const auto frame = core::render_frame(renderer, core::render_window(job.film),
                                        job.sampling.samples, view.frame, {.threads = 2});
  picture.image = frame.film.normalised();
  leave_picture(picture.image, name);
  return picture;
}

}  // namespace hyades::test
