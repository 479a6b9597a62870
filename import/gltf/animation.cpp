#include "import/gltf/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "import/gltf/accessor.h"

namespace hyades::core {

namespace {

using Path = GltfChannel::Path;
using Interpolation = GltfChannel::Interpolation;

void normalize4(float* q) {
  const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-12F)) {
    q[0] = q[1] = q[2] = 0.0F;
    q[3] = 1.0F;
    return;
  }
  for (int i = 0; i < 4; ++i) q[i] /= length;
}

/// From quaternion a to b by the shorter way at even speed (Shoemake 1985).
void slerp(const float* a, const float* b, float u, float* out) {
  float cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const float sign = cosine < 0.0F ? -1.0F : 1.0F;
  cosine = std::min(std::fabs(cosine), 1.0F);
  float wa = 1.0F - u;
  float wb = u;
  if (cosine < 0.9995F) {
    const float angle = std::acos(cosine);
    wa = std::sin((1.0F - u) * angle) / std::sin(angle);
    wb = std::sin(u * angle) / std::sin(angle);
  }
  for (int i = 0; i < 4; ++i) out[i] = wa * a[i] + sign * wb * b[i];
  normalize4(out);
}

size_t width_of(Path path, const GltfModel& model, int node) {
  if (path == Path::rotation) return 4;
  if (path != Path::weights) return 3;
  const int mesh = model.nodes[static_cast<size_t>(node)].mesh;
  if (mesh < 0) return 0;
  size_t targets = 0;
  for (const GltfPrimitive& p : model.meshes[static_cast<size_t>(mesh)].primitives) {
    targets = std::max(targets, p.targets.size());
  }
  return targets;
}

Result<GltfTrack> read_track(const GltfModel& model, const GltfChannel& channel, size_t width) {
  GltfTrack track;
  track.path = channel.path;
  track.interpolation = channel.interpolation;
  track.width = width;
  auto times = read_floats(model, channel.input, 1);
  if (!times) return times.error();
  auto values = read_floats(model, channel.output, 0);
  if (!values) return values.error();
  track.times = std::move(*times);
  track.values = std::move(*values);
  const size_t n = track.times.size();
  const auto wrong = [&](const std::string& what) {
    return model.error(channel.place + " " + what);
  };
  if (n == 0) return wrong("has no keys");
  const size_t expected = n * width * (channel.interpolation == Interpolation::cubic ? 3 : 1);
  if (track.values.size() != expected) {
    return wrong(
        fmt::format("has {} keys and {} numbers, expected {}", n, track.values.size(), expected));
  }
  for (size_t i = 0; i < n; ++i) {
    if (track.times[i] < 0.0F || track.times[i] > 1e5F ||
        (i > 0 && track.times[i] < track.times[i - 1])) {
      return wrong(fmt::format("has key {} at {} s; expected times from 0 to 100000 in order", i,
                               track.times[i]));
    }
  }
  if (channel.path == Path::rotation && channel.interpolation != Interpolation::cubic) {
    for (size_t i = 0; i < n; ++i) normalize4(track.values.data() + 4 * i);
  }
  return track;
}

}  // namespace

const float* GltfTrack::key(size_t i) const {
  return values.data() + (interpolation == Interpolation::cubic ? (3 * i + 1) * width : i * width);
}

bool GltfTrack::is_still() const {
  for (size_t i = 1; i < times.size(); ++i) {
    if (!std::equal(key(i), key(i) + width, key(0))) return false;
  }
  if (interpolation != Interpolation::cubic) return true;
  for (size_t i = 0; i < times.size(); ++i) {
    const auto zero = [](float x) { return x == 0.0F; };
    if (!std::all_of(key(i) - width, key(i), zero)) return false;
    if (!std::all_of(key(i) + width, key(i) + 2 * width, zero)) return false;
  }
  return true;
}

void GltfTrack::at(double time, float* out) const {
  const auto t = static_cast<float>(time);
  const auto after = std::upper_bound(times.begin(), times.end(), t);
  const size_t next = static_cast<size_t>(after - times.begin());
  if (next == 0 || next == times.size() || interpolation == Interpolation::step) {
    std::copy_n(key(next == 0 ? 0 : next - 1), width, out);
    if (path == Path::rotation) normalize4(out);
    return;
  }
  const size_t before = next - 1;
  const float span = times[next] - times[before];
  const float u = span > 0.0F ? (t - times[before]) / span : 0.0F;
  const float* a = key(before);
  const float* b = key(next);
  if (interpolation == Interpolation::cubic) {
    // Hermite's cubic (glTF 2.0, appendix C.5); tangents are per second.
    const float u2 = u * u;
    const float u3 = u2 * u;
    for (size_t i = 0; i < width; ++i) {
      out[i] =
          (2 * u3 - 3 * u2 + 1) * a[i] + span * (u3 - 2 * u2 + u) * a[width + i] +
          (3 * u2 - 2 * u3) * b[i] +
          span * (u3 - u2) * b[static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(width)];
    }
    if (path == Path::rotation) normalize4(out);
  } else if (path == Path::rotation) {
    slerp(a, b, u, out);
  } else {
    for (size_t i = 0; i < width; ++i) out[i] = a[i] + u * (b[i] - a[i]);
  }
}

const GltfTrack* GltfClip::track(int node, GltfChannel::Path path) const {
  for (const GltfTrack& each : tracks[static_cast<size_t>(node)]) {
    if (each.path == path) return &each;
  }
  return nullptr;
}

bool GltfClip::moves(int node) const {
  const std::vector<GltfTrack>& all = tracks[static_cast<size_t>(node)];
  return std::any_of(all.begin(), all.end(), [](const GltfTrack& track) {
    return track.path != Path::weights && !track.is_still();
  });
}

Result<std::shared_ptr<const GltfClip>> read_clip(const GltfModel& model, size_t index) {
  const GltfAnimation& animation = model.animations[index];
  auto clip = std::make_shared<GltfClip>();
  clip->name = animation.name;
  clip->tracks.resize(model.nodes.size());
  constexpr size_t kMostNotes = 10;
  size_t left_out = 0;
  for (const GltfChannel& channel : animation.channels) {
    const GltfNode& node = model.nodes[static_cast<size_t>(channel.node)];
    const size_t width = width_of(channel.path, model, channel.node);
    const char* why = nullptr;
    if (width == 0) why = "which has no morph targets";
    if (node.matrix && channel.path != Path::weights) why = "which has a matrix";
    if (clip->track(channel.node, channel.path) != nullptr) why = "as another channel does";
    if (why != nullptr) {
      if (left_out++ < kMostNotes) {
        clip->notes.push_back(fmt::format("{} is left out: it moves nodes[{}], {}", channel.place,
                                          channel.node, why));
      }
      continue;
    }
    auto track = read_track(model, channel, width);
    if (!track) return track.error();
    clip->duration = std::max(clip->duration, static_cast<double>(track->times.back()));
    clip->tracks[static_cast<size_t>(channel.node)].push_back(std::move(*track));
  }
  if (left_out > kMostNotes) {
    clip->notes.push_back(fmt::format("animations[{}]: {} more channels are left out likewise",
                                      index, left_out - kMostNotes));
  }
  clip->carried.assign(model.nodes.size(), 0);
  for (const int node : model.order) {
    const int parent = model.nodes[static_cast<size_t>(node)].parent;
    const bool with_parent = parent >= 0 && clip->carried[static_cast<size_t>(parent)] != 0;
    clip->carried[static_cast<size_t>(node)] = with_parent || clip->moves(node) ? 1 : 0;
  }
  for (const GltfSkin& skin : model.skins) {
    const bool moving = std::any_of(skin.joints.begin(), skin.joints.end(), [&](int joint) {
      return clip->carried[static_cast<size_t>(joint)] != 0;
    });
    clip->moving_skins.push_back(moving ? 1 : 0);
  }
  return std::shared_ptr<const GltfClip>(std::move(clip));
}

Mat4 matrix_of(const GltfPlace& place) {
  const Vec4& q = place.rotation;
  const float x = q.x;
  const float y = q.y;
  const float z = q.z;
  const float w = q.w;
  Mat4 m(1.0F);
  m[0] = Vec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0) * place.scale.x;
  m[1] = Vec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0) * place.scale.y;
  m[2] = Vec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0) * place.scale.z;
  m[3] = Vec4(place.translation, 1.0F);
  return m;
}

Mat4 local_matrix(const GltfModel& model, const GltfClip* clip, int node, double time) {
  const GltfNode& at = model.nodes[static_cast<size_t>(node)];
  if (at.matrix) return *at.matrix;
  GltfPlace place = at.place;
  if (clip != nullptr) {
    for (const GltfTrack& track : clip->tracks[static_cast<size_t>(node)]) {
      if (track.path == Path::translation) track.at(time, &place.translation.x);
      if (track.path == Path::rotation) track.at(time, &place.rotation.x);
      if (track.path == Path::scale) track.at(time, &place.scale.x);
    }
  }
  return matrix_of(place);
}

GltfPose pose_at(const GltfModel& model, const GltfClip* clip, double time) {
  GltfPose pose;
  pose.world.assign(model.nodes.size(), Mat4(1.0F));
  for (const int node : model.order) {
    const int parent = model.nodes[static_cast<size_t>(node)].parent;
    const Mat4 own = local_matrix(model, clip, node, time);
    pose.world[static_cast<size_t>(node)] =
        parent >= 0 ? pose.world[static_cast<size_t>(parent)] * own : own;
  }
  return pose;
}

std::vector<float> weights_at(const GltfModel& model, const GltfClip* clip, int node, double time,
                              size_t targets) {
  const GltfNode& at = model.nodes[static_cast<size_t>(node)];
  std::vector<float> weights =
      at.weights.empty() ? model.meshes[static_cast<size_t>(at.mesh)].weights : at.weights;
  const GltfTrack* track = clip != nullptr ? clip->track(node, Path::weights) : nullptr;
  if (track != nullptr) {
    weights.resize(track->width);
    track->at(time, weights.data());
  }
  weights.resize(targets, 0.0F);
  return weights;
}

}  // namespace hyades::core
