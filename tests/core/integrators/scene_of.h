#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {

/// A job written in a test and its scene at frame 1. Throws where the job has mistakes.
struct TestScene {
  explicit TestScene(const std::string& yaml) {
    MemoryAssets assets;
    Diagnostics diagnostics;
    job = parse_job("hyades: 1\n" + yaml, "test.yaml", assets, diagnostics);
    if (!diagnostics.empty()) throw std::runtime_error(diagnostics.to_string());
    SceneCache cache(assets);
    auto built = build_scene(job, 1, cache);
    if (!built) throw std::runtime_error(built.error().message);
    scene = *built;
  }

  Job job;
  std::shared_ptr<const Scene> scene;
};

}  // namespace hyades::core
