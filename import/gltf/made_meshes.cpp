#include "import/gltf/made_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/mutex.h"
#include "core/geometry/write_ply.h"
#include "import/gltf/accessor.h"
#include "import/gltf/geometry.h"
#include "import/names.h"

namespace hyades::core {

namespace {

constexpr std::string_view kLoop = "loop/";

/// Whether a node shapes the mesh that it shows.
bool shapes(const GltfNode& node, const GltfPrimitive& primitive) {
  return node.skin >= 0 || !primitive.targets.empty();
}

/// The vertices that are made of a primitive, or its triangles where these are more. Packed ones
/// say it of themselves; they count as much as the bytes of their code at least.
uint64_t elements_of(const GltfModel& model, const GltfPrimitive& primitive) {
  const auto count = [&](int index) {
    if (index < 0) return size_t{0};
    const GltfAccessor& accessor = model.accessors[static_cast<size_t>(index)];
    // One of zeros that is longer is refused by who reads it.
    return accessor.view < 0 ? std::min(accessor.count, model.buffer_bytes) : accessor.count;
  };
  const auto position = primitive.attributes.find("POSITION");
  const size_t vertices = position == primitive.attributes.end() ? 0 : count(position->second);
  const size_t corners = count(primitive.indices);
  const size_t code =
      primitive.draco ? model.views[static_cast<size_t>(primitive.draco->view)].bytes.size() : 0;
  return std::max({vertices, primitive.mode == 4 ? corners / 3 : corners, code});
}

Result<std::vector<Mat4>> joint_matrices(const GltfModel& model, const GltfSkin& skin,
                                         const GltfClip* clip, double time) {
  const GltfPose pose = pose_at(model, clip, time);
  std::vector<Mat4> joints;
  std::vector<float> binds;
  if (skin.inverse_bind >= 0) {
    auto read = read_floats(model, skin.inverse_bind, 16);
    if (!read) return read.error();
    binds = std::move(*read);
  }
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    Mat4 bind(1.0F);
    if (!binds.empty())
      std::copy_n(binds.begin() + static_cast<std::ptrdiff_t>(16 * i), 16, &bind[0][0]);
    joints.push_back(pose.world[static_cast<size_t>(skin.joints[i])] * bind);
  }
  return joints;
}

/// The mesh in the terms of jobs: v of uv grows upwards.
TriangleMesh mesh_of(GltfGeometry geometry) {
  TriangleMesh mesh;
  for (std::vector<Vec2>& uvs : geometry.uvs) {
    for (Vec2& uv : uvs) uv.y = 1.0F - uv.y;
  }
  mesh.positions = std::move(geometry.positions);
  mesh.triangles = std::move(geometry.triangles);
  mesh.normals = std::move(geometry.normals);
  mesh.uvs = std::move(geometry.uvs[0]);
  mesh.second_uvs = std::move(geometry.uvs[1]);
  mesh.colors = std::move(geometry.colors);
  // Of facets the file's tangents mean nothing.
  if (!mesh.normals.empty()) mesh.vertex_tangents = std::move(geometry.tangents);
  return mesh;
}

/// The number that a text is, all of it.
template <class T>
bool parse(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

Result<GltfGeometry> shaped_geometry(const GltfModel& model, const GltfMeshFile& file,
                                     const GltfClip* clip, double time) {
  const GltfPrimitive& primitive =
      model.meshes[static_cast<size_t>(file.mesh)].primitives[file.primitive];
  auto geometry = read_geometry(model, primitive);
  if (!geometry || file.node < 0) return geometry;
  const std::vector<float> weights =
      weights_at(model, clip, file.node, time, primitive.targets.size());
  if (Status s = morph(model, primitive, weights, *geometry); !s) return s.error();
  const int skin_index = model.nodes[static_cast<size_t>(file.node)].skin;
  if (skin_index < 0) return geometry;
  const GltfSkin& bones_of = model.skins[static_cast<size_t>(skin_index)];
  const auto bones =
      read_bones(model, primitive, geometry->positions.size(), bones_of.joints.size());
  if (!bones) return bones.error();
  const auto joints = joint_matrices(model, bones_of, clip, time);
  if (!joints) return joints.error();
  skin(*bones, *joints, *geometry);
  return geometry;
}

GltfMeshFiles::GltfMeshFiles(std::shared_ptr<const GltfModel> model) : model_(std::move(model)) {
  Names names("mesh");
  std::map<std::pair<int, size_t>, size_t> unshaped;
  for (const int node : model_->order) {
    const GltfNode& at = model_->nodes[static_cast<size_t>(node)];
    if (at.mesh < 0) continue;
    const GltfMesh& mesh = model_->meshes[static_cast<size_t>(at.mesh)];
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      const bool own = shapes(at, mesh.primitives[p]);
      const auto known = unshaped.find({at.mesh, p});
      if (!own && known != unshaped.end()) {
        of_node_[{node, p}] = known->second;
        continue;
      }
      const std::string base = safe_name(mesh.name.empty() ? at.name : mesh.name, "mesh");
      const std::string part = mesh.primitives.size() > 1 ? "-" + std::to_string(p + 1) : "";
      files_.push_back({names.add(base + part), at.mesh, p, own ? node : -1});
      elements_ += elements_of(*model_, mesh.primitives[p]);
      by_name_[files_.back().name] = files_.size() - 1;
      of_node_[{node, p}] = files_.size() - 1;
      if (!own) unshaped[{at.mesh, p}] = files_.size() - 1;
    }
  }
  Names clip_names("animation");
  for (const GltfAnimation& animation : model_->animations) {
    clip_folders_.push_back(clip_names.add(safe_name(animation.name, "animation")));
  }
}

const GltfMeshFile& GltfMeshFiles::file(int node, size_t primitive) const {
  return files_[of_node_.at({node, primitive})];
}

bool GltfMeshFiles::changes(const GltfMeshFile& file, const GltfClip& clip) const {
  if (file.node < 0) return false;
  const GltfTrack* weights = clip.track(file.node, GltfChannel::Path::weights);
  if (weights != nullptr && !weights->is_still()) return true;
  const int skin = model_->nodes[static_cast<size_t>(file.node)].skin;
  return skin >= 0 && clip.moving_skins[static_cast<size_t>(skin)] != 0;
}

std::string GltfMeshFiles::folder(float fps, size_t animation, bool loop) const {
  return fmt::format("{}{}/{}/", loop ? kLoop : "", fps, clip_folders_[animation]);
}

Result<std::shared_ptr<const GltfClip>> GltfMeshFiles::clip(size_t index) const {
  const MutexLock lock(mutex_);
  std::shared_ptr<const GltfClip>& known = clips_[index];
  if (known == nullptr) {
    auto read = read_clip(*model_, index);
    if (!read) return read.error();
    known = *read;
  }
  return known;
}

std::optional<size_t> GltfMeshFiles::clip_in_folder(std::string_view folder) const {
  const auto at = std::find(clip_folders_.begin(), clip_folders_.end(), folder);
  if (at == clip_folders_.end()) return std::nullopt;
  return static_cast<size_t>(at - clip_folders_.begin());
}

int GltfMeshFiles::animation_named(const std::string& name) const {
  for (size_t i = 0; i < clip_folders_.size(); ++i) {
    if (model_->animations[i].name == name) return static_cast<int>(i);
  }
  for (size_t i = 0; i < clip_folders_.size(); ++i) {
    if (clip_folders_[i] == name) return static_cast<int>(i);
  }
  return -1;
}

Result<Bytes> GltfMeshFiles::made(const std::string& name) const {
  const Error unknown = model_->error("it has no part '" + name + "'");
  std::string_view rest = name;
  if (!rest.starts_with("meshes/") || !rest.ends_with(".ply")) return unknown;
  rest = rest.substr(7, rest.size() - 11);
  std::shared_ptr<const GltfClip> clip;
  double time = 0.0;
  const size_t slash = rest.rfind('/');
  if (slash != std::string_view::npos) {
    const bool loop = rest.starts_with(kLoop);
    const size_t begin = loop ? kLoop.size() : 0;
    if (slash < begin) return unknown;
    const std::string_view folder = rest.substr(begin, slash - begin);
    rest = rest.substr(slash + 1);
    const size_t middle = folder.find('/');
    const size_t dot = rest.rfind('.');
    float fps = 0.0F;
    int32_t frame = 0;
    if (middle == std::string_view::npos || dot == std::string_view::npos ||
        !parse(folder.substr(0, middle), fps) || !(fps > 0.0F) ||
        !parse(rest.substr(dot + 1), frame)) {
      return unknown;
    }
    const auto index = clip_in_folder(folder.substr(middle + 1));
    if (!index) return unknown;
    auto read = this->clip(*index);
    if (!read) return read.error();
    clip = *read;
    time = (static_cast<double>(frame) - 1.0) / static_cast<double>(fps);
    if (loop && clip->duration > 0.0) time -= clip->duration * std::floor(time / clip->duration);
    rest = rest.substr(0, dot);
  }
  const auto file = by_name_.find(std::string(rest));
  if (file == by_name_.end()) return unknown;
  auto geometry = shaped_geometry(*model_, files_[file->second], clip.get(), time);
  if (!geometry) return geometry.error();
  return ply_bytes(mesh_of(std::move(*geometry)));
}

}  // namespace hyades::core
