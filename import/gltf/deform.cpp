#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "import/gltf/accessor.h"
#include "import/gltf/geometry.h"

namespace hyades::core {

namespace {

Status add_target(const GltfModel& model, const GltfPrimitive& primitive,
                  const GltfAttributes& target, const char* name, float weight, float* to,
                  size_t vertices, size_t step) {
  const auto at = target.find(name);
  if (at == target.end()) return {};
  const auto moves = read_floats(model, at->second, 3);
  if (!moves) return moves.error();
  if (moves->size() != 3 * vertices) {
    return model.error(fmt::format("{} has {} vertices, but {} of {} in a target", primitive.place,
                                   vertices, moves->size() / 3, name));
  }
  for (size_t i = 0; i < vertices; ++i) {
    for (size_t k = 0; k < 3; ++k) to[i * step + k] += weight * (*moves)[3 * i + k];
  }
  return {};
}

Vec3 unit(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0.0F ? v / length : v;
}

/// A unit normal under `matrix`, by its cofactors: these are there where the inverse is not, as of
/// joints that are scaled to 0 to hide what hangs on them. The normal itself where nothing is left.
Vec3 turned_normal(const Mat3& matrix, const Vec3& normal) {
  const Mat3 cofactors(glm::cross(matrix[1], matrix[2]), glm::cross(matrix[2], matrix[0]),
                       glm::cross(matrix[0], matrix[1]));
  const float mirrored = glm::determinant(matrix) < 0.0F ? -1.0F : 1.0F;
  const Vec3 turned = mirrored * (cofactors * normal);
  const float length = glm::length(turned);
  return length > 0.0F ? turned / length : normal;
}

}  // namespace

Status morph(const GltfModel& model, const GltfPrimitive& primitive,
             const std::vector<float>& weights, GltfGeometry& geometry) {
  const size_t n = geometry.positions.size();
  if (model.is_too_much(primitive.targets.size() * n)) {
    return model.error(
        fmt::format("{} has {} targets of {} vertices, which is too much for {} "
                    "bytes",
                    primitive.place, primitive.targets.size(), n, model.buffer_bytes));
  }
  for (size_t i = 0; i < primitive.targets.size() && i < weights.size(); ++i) {
    if (weights[i] == 0.0F) continue;
    const GltfAttributes& target = primitive.targets[i];
    const auto add = [&](const char* name, float* to, size_t step) {
      return add_target(model, primitive, target, name, weights[i], to, n, step);
    };
    if (Status s = add("POSITION", &geometry.positions[0].x, 3); !s) return s;
    if (!geometry.normals.empty()) {
      if (Status s = add("NORMAL", &geometry.normals[0].x, 3); !s) return s;
    }
    if (!geometry.tangents.empty()) {
      if (Status s = add("TANGENT", &geometry.tangents[0].x, 4); !s) return s;
    }
  }
  for (Vec3& normal : geometry.normals) normal = unit(normal);
  return {};
}

Result<GltfBones> read_bones(const GltfModel& model, const GltfPrimitive& primitive,
                             size_t vertices, size_t joints) {
  GltfBones out;
  std::vector<std::vector<uint32_t>> ids;
  std::vector<std::vector<float>> shares;
  for (size_t set = 0;; ++set) {
    const auto at = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    const auto by = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
    if (at == primitive.attributes.end() || by == primitive.attributes.end()) break;
    auto id = read_whole(model, at->second, 4);
    if (!id) return id.error();
    auto share = read_floats(model, by->second, 4);
    if (!share) return share.error();
    if (id->size() != 4 * vertices || share->size() != 4 * vertices) {
      return model.error(fmt::format("{} has {} vertices, but {} of JOINTS_{}", primitive.place,
                                     vertices, id->size() / 4, set));
    }
    ids.push_back(std::move(*id));
    shares.push_back(std::move(*share));
  }
  out.each = 4 * ids.size();
  for (size_t i = 0; i < vertices && out.each > 0; ++i) {
    float sum = 0.0F;
    for (const std::vector<float>& share : shares) {
      for (size_t k = 0; k < 4; ++k) sum += share[4 * i + k];
    }
    for (size_t s = 0; s < ids.size(); ++s) {
      for (size_t k = 0; k < 4; ++k) {
        const float share = shares[s][4 * i + k];
        const uint32_t joint = share != 0.0F ? ids[s][4 * i + k] : 0;
        if (joint >= joints) {
          return model.error(fmt::format("{} has joint {} at vertex {}, but its skin has {}",
                                         primitive.place, joint, i, joints));
        }
        out.joints.push_back(joint);
        out.weights.push_back(sum > 0.0F ? share / sum : (s + k == 0 ? 1.0F : 0.0F));
      }
    }
  }
  return out;
}

void skin(const GltfBones& bones, const std::vector<Mat4>& joints, GltfGeometry& geometry) {
  if (bones.each == 0) return;
  for (size_t i = 0; i < geometry.positions.size(); ++i) {
    Mat4 matrix(0.0F);
    for (size_t k = bones.each * i; k < bones.each * (i + 1); ++k) {
      if (bones.weights[k] != 0.0F) matrix += bones.weights[k] * joints[bones.joints[k]];
    }
    geometry.positions[i] = transform_point(matrix, geometry.positions[i]);
    if (!geometry.normals.empty()) {
      geometry.normals[i] = turned_normal(Mat3(matrix), geometry.normals[i]);
    }
    if (!geometry.tangents.empty()) {
      const Vec3 turned = unit(transform_vector(matrix, Vec3(geometry.tangents[i])));
      geometry.tangents[i] = Vec4(turned, geometry.tangents[i].w);
    }
  }
}

}  // namespace hyades::core
