#include "jobs/generator/surface_nets.h"

#include <cmath>
#include <cstddef>

namespace hyades::gallery {
namespace {

constexpr uint32_t kNone = ~0U;

class SurfaceNet {
 public:
  SurfaceNet(const SampledBox& box, const std::function<float(const Vec3&)>& distance)
      : box_(box), distance_(distance) {
    for (int a = 0; a < 3; ++a)
      size_[a] = static_cast<int>(std::ceil((box.high[a] - box.low[a]) / box.cell)) + 1;
  }

  Mesh make() {
    sample();
    place_vertices();
    connect();
    return std::move(mesh_);
  }

 private:
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(size_[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(size_[0]) +
           static_cast<size_t>(x);
  }

  Vec3 corner(int x, int y, int z) const {
    return box_.low +
           box_.cell * Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }

  void sample() {
    values_.resize(index(0, 0, size_[2]));
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) values_[index(x, y, z)] = distance_(corner(x, y, z));
  }

  void place_vertices() {
    vertices_.assign(values_.size(), kNone);
    for (int z = 0; z + 1 < size_[2]; ++z)
      for (int y = 0; y + 1 < size_[1]; ++y)
        for (int x = 0; x + 1 < size_[0]; ++x) place_vertex(x, y, z);
  }

  /// The vertex of the cube whose low corner is (x, y, z), where the surface passes it.
  void place_vertex(int x, int y, int z) {
    Vec3 sum(0.0F);
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 4; ++k) {
        int from[3] = {x, y, z};
        from[(axis + 1) % 3] += k & 1;
        from[(axis + 2) % 3] += k >> 1;
        int to[3] = {from[0], from[1], from[2]};
        ++to[axis];
        const float a = values_[index(from[0], from[1], from[2])];
        const float b = values_[index(to[0], to[1], to[2])];
        if ((a < 0.0F) == (b < 0.0F)) continue;
        const Vec3 p = corner(from[0], from[1], from[2]);
        sum += p + (corner(to[0], to[1], to[2]) - p) * (a / (a - b));
        ++crossings;
      }
    }
    if (crossings == 0) return;
    const Vec3 place = sum / static_cast<float>(crossings);
    vertices_[index(x, y, z)] = static_cast<uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(place);
    mesh_.normals.push_back(normal_at(place));
  }

  Vec3 normal_at(const Vec3& p) const {
    const float e = 0.25F * box_.cell;
    const auto slope = [&](const Vec3& d) { return distance_(p + e * d) - distance_(p - e * d); };
    return glm::normalize(Vec3(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})));
  }

  /// Around every edge that the surface crosses, the vertices of the four cubes that share it.
  void connect() {
    for (int z = 1; z + 1 < size_[2]; ++z)
      for (int y = 1; y + 1 < size_[1]; ++y)
        for (int x = 1; x + 1 < size_[0]; ++x)
          for (int axis = 0; axis < 3; ++axis) connect_edge(x, y, z, axis);
  }

  void connect_edge(int x, int y, int z, int axis) {
    int to[3] = {x, y, z};
    ++to[axis];
    const bool inside = values_[index(x, y, z)] < 0.0F;
    if (inside == (values_[index(to[0], to[1], to[2])] < 0.0F)) return;
    uint32_t quad[4];
    for (int k = 0; k < 4; ++k) {
      int cube[3] = {x, y, z};
      cube[(axis + 1) % 3] -= k == 1 || k == 2 ? 1 : 0;
      cube[(axis + 2) % 3] -= k >= 2 ? 1 : 0;
      quad[k] = vertices_[index(cube[0], cube[1], cube[2])];
    }
    if (inside) {
      mesh_.triangles.push_back({quad[0], quad[1], quad[2]});
      mesh_.triangles.push_back({quad[0], quad[2], quad[3]});
    } else {
      mesh_.triangles.push_back({quad[0], quad[2], quad[1]});
      mesh_.triangles.push_back({quad[0], quad[3], quad[2]});
    }
  }

  const SampledBox& box_;
  const std::function<float(const Vec3&)>& distance_;
  int size_[3] = {};
  std::vector<float> values_;
  std::vector<uint32_t> vertices_;  ///< by the low corner of their cubes
  Mesh mesh_;
};

}  // namespace

Mesh make_surface(const SampledBox& box, const std::function<float(const Vec3&)>& distance) {
  return SurfaceNet(box, distance).make();
}

}  // namespace hyades::gallery
