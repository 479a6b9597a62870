#include "tests/truth/render_yaml.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/support/tested_class.h"

namespace hyades::test {

YamlScene::YamlScene(const std::string& yaml, int32_t frame, const core::LayerSet& layers,
                     const std::string& folder)
    : assets_(core::make_file_resolver(folder)), frame_(frame) {
  core::Diagnostics diagnostics;
  job_ = core::parse_job(yaml, "test.yaml", *assets_, diagnostics);
  if (!diagnostics.empty()) throw std::runtime_error(diagnostics.to_string());
  job_.render.render_class = tested_class();
  cache_ = std::make_unique<core::SceneCache>(*assets_);
  auto scene = core::build_scene(job_, frame, *cache_);
  if (!scene) throw std::runtime_error(scene.error().message);
  core::LayerSet all = layers;
  all.splats = core::makes_splats(job_.integrator);
  renderer_ = std::make_unique<core::FrameRenderer>(*scene, job_, frame, all);
}

core::RenderedFrame YamlScene::render(const core::RenderFrameOptions& options) const {
  return core::render_frame(*renderer_, core::render_window(job_.film), job_.sampling.samples,
                            frame_, options);
}

core::RenderedFrame YamlScene::render_by(const core::IntegratorDesc& integrator) const {
  core::Job job = job_;
  job.integrator = integrator;
  core::LayerSet layers = renderer_->layout().layers;
  layers.splats = core::makes_splats(job.integrator);
  // The scene outlives the renderer.
  const std::shared_ptr<const core::Scene> shared(std::shared_ptr<void>(), &renderer_->scene());
  const core::FrameRenderer renderer(shared, job, frame_, layers);
  return core::render_frame(renderer, core::render_window(job.film), job.sampling.samples, frame_,
                            {.threads = 2});
}

PictureMean picture_mean(const core::Film& film) {
  const core::Image picture = film.normalised();
  const int variance = picture.find_channel("variance.R");
  PictureMean result;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        result.mean[c] += static_cast<double>(picture.at(x, y, c));
        result.sigma[c] += static_cast<double>(picture.at(x, y, variance + c));
      }
    }
  }
  const double pixels = static_cast<double>(picture.width) * picture.height;
  for (int c = 0; c < 3; ++c) {
    result.mean[c] /= pixels;
    result.sigma[c] = std::sqrt(result.sigma[c]) / pixels;
  }
  return result;
}

namespace {

void expect_film_mean(const core::Film& film, const core::Vec3d& expected, const Promise& promise) {
  const PictureMean picture = picture_mean(film);
  const double alpha = sidak(promise.significance, promise.tests);
  for (int c = 0; c < 3; ++c) {
    const double variance = picture.sigma[c] * picture.sigma[c];
    EXPECT_LE(detectable_effect(variance, alpha, promise.power),
              promise.relative_error * std::abs(expected[c]))
        << "underpowered: mean " << picture.mean[c] << " +- " << picture.sigma[c];
    // Where nothing varies, float rounding is all there is.
    const double rounding = 1e-5 * std::abs(expected[c]);
    EXPECT_GE(z_test(picture.mean[c] - expected[c], variance + rounding * rounding), alpha)
        << "channel " << c << ": mean " << picture.mean[c] << " +- " << picture.sigma[c]
        << ", expected " << expected[c];
  }
}

}  // namespace

void expect_picture_mean(const YamlScene& scene, const core::Vec3d& expected,
                         const Promise& promise) {
  expect_film_mean(scene.render().film, expected, promise);
}

void expect_mean_by_path_and_bdpt(const YamlScene& scene, const core::Vec3d& expected,
                                  const Promise& promise) {
  for (const char* type : {"path", "bdpt"}) {
    SCOPED_TRACE(type);
    core::IntegratorDesc integrator = scene.job().integrator;
    integrator.type = type;
    expect_film_mean(scene.render_by(integrator).film, expected, promise);
  }
}

std::string shared_folder() {
  const char* named = std::getenv("HYADES_SHARED");
  const std::filesystem::path folder = named != nullptr ? named : "../shared";
  return std::filesystem::exists(folder / "assets") ? folder.string() : "";
}

std::string with_shared_folder(std::string text) {
  const std::string written = "../../../shared/";
  const std::string there = (std::filesystem::current_path() / shared_folder() / "").string();
  for (size_t at = 0; (at = text.find(written, at)) != std::string::npos; at += there.size())
    text.replace(at, written.size(), there);
  return text;
}

}  // namespace hyades::test
