#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "import/gltf/model.h"

namespace hyades::core {

/// How one property of a node moves: keyed values.
struct GltfTrack {
  GltfChannel::Path path = GltfChannel::Path::translation;
  GltfChannel::Interpolation interpolation = GltfChannel::Interpolation::linear;
  size_t width = 3;           ///< numbers of a value
  std::vector<float> times;   ///< [s], ascending, at least one
  std::vector<float> values;  ///< width each; cubic: in-tangent, value, out-tangent each

  /// Value of key i.
  const float* key(size_t i) const;
  /// Whether all keys have the same value.
  bool is_still() const;
  /// The value at `time`, before the first and after the last key theirs, in out[0..width). Turns
  /// are of unit length.
  void at(double time, float* out) const;
};

/// An animation that has been read: tracks by node.
struct GltfClip {
  std::string name;
  double duration = 0.0;  ///< last key of all [s]
  std::vector<std::vector<GltfTrack>> tracks;
  std::vector<uint8_t> carried;       ///< by node: whether it or one above it moves
  std::vector<uint8_t> moving_skins;  ///< by skin: whether one of its joints does
  std::vector<std::string> notes;     ///< channels that are left out

  const GltfTrack* track(int node, GltfChannel::Path path) const;
  bool moves(int node) const;  ///< whether translation, rotation or scale change
};

/// Reads animation `index`; errors name the channel. Channels of nodes that have a matrix, second
/// ones of the same property, and weights of what has no morph targets are left out and noted.
Result<std::shared_ptr<const GltfClip>> read_clip(const GltfModel& model, size_t index);

/// Where the nodes are at one moment.
struct GltfPose {
  std::vector<Mat4> world;  ///< by node; identity for those outside of the scene
};

Mat4 matrix_of(const GltfPlace& place);

/// A node's own matrix at `time`; without a clip, as the file places it.
Mat4 local_matrix(const GltfModel& model, const GltfClip* clip, int node, double time);

GltfPose pose_at(const GltfModel& model, const GltfClip* clip, double time);

/// The weights of a node's morph targets at `time`; as many as `targets`.
std::vector<float> weights_at(const GltfModel& model, const GltfClip* clip, int node, double time,
                              size_t targets);

}  // namespace hyades::core
