#pragma once

#include <functional>
#include <vector>

#include "core/job/yaml_build.h"
#include "import/gltf/animation.h"

/// Motion in the language of jobs: frame = 1 + time * fps.
namespace hyades::core {

/// The moments of a job at which something is told that has no keys of its own there.
struct GltfFrames {
  float fps = 24.0F;
  int last = 1;  ///< frames 1 to this one show the clip
  /// Where the clip begins again, as a frame (perhaps a fraction of one); 0: nowhere, its last pose
  /// stays.
  double seam = 0.0;

  /// Most keys of what is told frame by frame; of longer clips every second, third, ... frame.
  static constexpr int kMostKeys = 20'000;

  int step() const { return 1 + last / kMostKeys; }
  bool loop() const { return seam > 0.0; }
  double time(double frame) const { return (frame - 1) / static_cast<double>(fps); }
};

/// The steps that bring the space of a node into that of the scene: what stands still as one
/// matrix, what moves as keys. Empty where nothing is changed.
std::vector<YamlPtr> transform_steps(const GltfModel& model, const GltfClip* clip, int node,
                                     const GltfFrames& frames);

/// Whether a node or one above it moves.
bool moves_in_scene(const GltfClip* clip, int node);

/// A vector that is `at(matrix of the node in the scene)`: a constant, or keys at every frame.
YamlPtr moving_vector(const GltfModel& model, const GltfClip* clip, int node,
                      const GltfFrames& frames, const std::function<Vec3(const Mat4&)>& at);

/// A matrix as a transform step.
YamlPtr matrix_step(const Mat4& matrix);

/// A node's matrix in the scene at `time`.
Mat4 world_matrix(const GltfModel& model, const GltfClip* clip, int node, double time);

}  // namespace hyades::core
