#include "import/gltf/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace hyades::core {

namespace {

using Path = GltfChannel::Path;
using Interpolation = GltfChannel::Interpolation;

std::string frame_text(double frame) { return fmt::format("{}", static_cast<float>(frame)); }

/// Keys in the making.
class Keys {
 public:
  explicit Keys(const GltfFrames& frames) : frames_(frames) {}

  void put(double frame, const YamlPtr& value) {
    const std::string text = frame_text(frame);
    if (text != last_) keys_.put(text, value);
    last_ = text;
  }

  /// `value` at every frame, and where the clip begins again.
  template <class Value>
  void put_each(const Value& value) {
    const double end = frames_.loop() ? frames_.seam : frames_.last + 1.0;
    for (int frame = 1; frame <= end; frame += frames_.step()) put(frame, value(frame));
    if (frames_.loop()) put(frames_.seam, value(frames_.seam));
  }

  YamlPtr node(const char* ease = nullptr) const {
    YamlMap out{{"keys", keys_.node()}};
    if (ease != nullptr) out.put("ease", yaml_word(ease));
    if (frames_.loop()) out.put("repeat", yaml_word("loop"));
    return out.node();
  }

 private:
  const GltfFrames& frames_;
  YamlMap keys_;
  std::string last_;  ///< frame
};

/// A track as a keyed value. Cubic splines, and linear ones whose keys lie closer than frames, are
/// told frame by frame.
YamlPtr track_keys(const GltfTrack& track, const GltfFrames& frames) {
  std::vector<float> value(track.width);
  Keys keys(frames);
  if (track.interpolation == Interpolation::cubic ||
      track.times.size() > static_cast<size_t>(4 * frames.last)) {
    keys.put_each([&](double frame) {
      track.at(frames.time(frame), value.data());
      return yaml_numbers(value);
    });
    return keys.node();
  }
  const auto key = [&](size_t i) {
    std::copy_n(track.key(i), track.width, value.begin());
    return yaml_numbers(value);
  };
  // What repeats does so from its first key to its last one: these stand at the clip's ends.
  if (frames.loop()) keys.put(1.0, key(0));
  for (size_t i = 0; i < track.times.size(); ++i) {
    keys.put(1.0 + static_cast<double>(track.times[i]) * static_cast<double>(frames.fps), key(i));
  }
  if (frames.loop()) keys.put(frames.seam, key(track.times.size() - 1));
  return keys.node(track.interpolation == Interpolation::step ? "step" : nullptr);
}

/// The steps of a node that moves, in its parent's space.
void add_moving(const GltfNode& node, const GltfClip& clip, int index, const GltfFrames& frames,
                std::vector<YamlPtr>& steps) {
  const auto moving = [&](Path path) -> const GltfTrack* {
    const GltfTrack* track = clip.track(index, path);
    return track != nullptr && !track->is_still() ? track : nullptr;
  };
  const auto still = [&](Path path, float* value) {
    const GltfTrack* track = clip.track(index, path);
    if (track != nullptr) track->at(0.0, value);
  };
  GltfPlace place = node.place;
  still(Path::translation, &place.translation.x);
  still(Path::rotation, &place.rotation.x);
  still(Path::scale, &place.scale.x);
  if (const GltfTrack* track = moving(Path::scale)) {
    steps.push_back(YamlMap{{"scale", track_keys(*track, frames)}}.node());
  } else if (place.scale != Vec3(1.0F)) {
    steps.push_back(YamlMap{{"scale", yaml_vector(place.scale)}}.node());
  }
  const GltfTrack* turn = moving(Path::rotation);
  const YamlPtr quaternion =
      turn != nullptr ? track_keys(*turn, frames) : yaml_numbers(std::span(&place.rotation.x, 4));
  if (turn != nullptr || place.rotation != Vec4(0.0F, 0.0F, 0.0F, 1.0F)) {
    steps.push_back(YamlMap{{"rotate", YamlMap{{"quaternion", quaternion}}.node()}}.node());
  }
  if (const GltfTrack* track = moving(Path::translation)) {
    steps.push_back(YamlMap{{"translate", track_keys(*track, frames)}}.node());
  } else if (place.translation != Vec3(0.0F)) {
    steps.push_back(YamlMap{{"translate", yaml_vector(place.translation)}}.node());
  }
}

}  // namespace

YamlPtr matrix_step(const Mat4& matrix) {
  std::array<float, 16> rows{};
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) rows[static_cast<size_t>(4 * r + c)] = matrix[c][r];
  }
  return YamlMap{{"matrix", yaml_numbers(rows)}}.node();
}

std::vector<YamlPtr> transform_steps(const GltfModel& model, const GltfClip* clip, int node,
                                     const GltfFrames& frames) {
  std::vector<YamlPtr> steps;
  Mat4 still(1.0F);  // of nodes that stand still, not yet told
  const auto tell = [&] {
    if (still != Mat4(1.0F)) steps.push_back(matrix_step(still));
    still = Mat4(1.0F);
  };
  uint64_t weight = 0;
  for (int at = node; at >= 0; at = model.nodes[static_cast<size_t>(at)].parent) {
    if (weight > kMaxYamlNodes) break;  // no document holds it; whoever adds it up will say so
    if (clip != nullptr && clip->moves(at)) {
      tell();
      add_moving(model.nodes[static_cast<size_t>(at)], *clip, at, frames, steps);
      weight = 0;
      for (const YamlPtr& step : steps) weight += step->weight;
    } else {
      still = local_matrix(model, clip, at, 0.0) * still;
    }
  }
  tell();
  return steps;
}

bool moves_in_scene(const GltfClip* clip, int node) {
  return clip != nullptr && clip->carried[static_cast<size_t>(node)] != 0;
}

Mat4 world_matrix(const GltfModel& model, const GltfClip* clip, int node, double time) {
  Mat4 matrix(1.0F);
  for (int at = node; at >= 0; at = model.nodes[static_cast<size_t>(at)].parent) {
    matrix = local_matrix(model, clip, at, time) * matrix;
  }
  return matrix;
}

YamlPtr moving_vector(const GltfModel& model, const GltfClip* clip, int node,
                      const GltfFrames& frames, const std::function<Vec3(const Mat4&)>& at) {
  if (!moves_in_scene(clip, node)) {
    return yaml_vector(at(world_matrix(model, clip, node, 0.0)));
  }
  Keys keys(frames);
  keys.put_each([&](double frame) {
    return yaml_vector(at(world_matrix(model, clip, node, frames.time(frame))));
  });
  return keys.node();
}

}  // namespace hyades::core
