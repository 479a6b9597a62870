#include "jobs/generator/shapes.h"

#include <cmath>

namespace hyades::gallery {
namespace {

constexpr double kTau = 6.283185307179586;

Vec3 knot_point(const KnotShape& shape, double t) {
  const double reach = 2.0 + std::cos(shape.q * t);
  return {reach * std::cos(shape.p * t), std::sin(shape.q * t), reach * std::sin(shape.p * t)};
}

Vec3 tube_point(const KnotShape& shape, double t, double angle) {
  const Vec3 p = knot_point(shape, t);
  const Vec3 tangent = glm::normalize(knot_point(shape, t + 1e-3) - knot_point(shape, t - 1e-3));
  // The direction away from the torus's core circle never meets the tangent: a frame without twist
  // jumps.
  const Vec3 core(2.0 * std::cos(shape.p * t), 0.0, 2.0 * std::sin(shape.p * t));
  const Vec3 away = p - core;
  const Vec3 side = glm::normalize(away - tangent * glm::dot(away, tangent));
  const Vec3 up = glm::cross(tangent, side);
  const double swell = 1.0 + shape.ridge * std::cos(shape.lobes * angle + shape.twist * t);
  const double r = shape.radius * swell;
  return p + side * static_cast<float>(r * std::cos(angle)) +
         up * static_cast<float>(r * std::sin(angle));
}

}  // namespace

Mesh make_knot(const KnotShape& shape) {
  Mesh mesh;
  for (int i = 0; i < shape.along; ++i) {
    const double t = kTau * i / shape.along;
    for (int j = 0; j < shape.around; ++j) {
      const double a = kTau * j / shape.around;
      constexpr double kStep = 1e-3;
      const Vec3 du = tube_point(shape, t + kStep, a) - tube_point(shape, t - kStep, a);
      const Vec3 dv = tube_point(shape, t, a + kStep) - tube_point(shape, t, a - kStep);
      mesh.positions.push_back(tube_point(shape, t, a));
      mesh.normals.push_back(glm::normalize(glm::cross(dv, du)));
      mesh.uvs.emplace_back(static_cast<float>(i) / static_cast<float>(shape.along),
                            static_cast<float>(j) / static_cast<float>(shape.around));
      const auto at = [&](int row, int column) {
        return static_cast<uint32_t>(row % shape.along * shape.around + column % shape.around);
      };
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  // Outward is away from the knot's own centre line.
  const Vec3 outward = mesh.positions[0] - knot_point(shape, 0.0);
  if (glm::dot(outward, mesh.normals[0]) < 0.0F) {
    for (Vec3& n : mesh.normals) n = -n;
  }
  const auto& t0 = mesh.triangles[0];
  const Vec3 face = glm::cross(mesh.positions[t0[1]] - mesh.positions[t0[0]],
                               mesh.positions[t0[2]] - mesh.positions[t0[0]]);
  if (glm::dot(face, mesh.normals[t0[0]]) < 0.0F) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

Mesh make_lathe(const std::vector<Vec2>& profile, int steps_per_span, int around) {
  std::vector<Vec2> curve;
  const int spans = static_cast<int>(profile.size()) - 1;
  const auto point = [&](int i) {
    return profile[static_cast<size_t>(std::min(std::max(i, 0), spans))];
  };
  for (int i = 0; i < spans; ++i) {
    for (int k = 0; k < steps_per_span; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps_per_span);
      const Vec2 a = point(i - 1), b = point(i), c = point(i + 1), d = point(i + 2);
      const Vec2 p =
          0.5F * ((2.0F * b) + (c - a) * t + (2.0F * a - 5.0F * b + 4.0F * c - d) * t * t +
                  (3.0F * b - a - 3.0F * c + d) * t * t * t);
      curve.emplace_back(std::max(p.x, 0.0F), p.y);
    }
  }
  curve.push_back(profile.back());

  Mesh mesh;
  const int rows = static_cast<int>(curve.size());
  for (int i = 0; i < rows; ++i) {
    const Vec2 before = curve[static_cast<size_t>(std::max(i - 1, 0))];
    const Vec2 after = curve[static_cast<size_t>(std::min(i + 1, rows - 1))];
    const Vec2 along = after - before;
    const float length = std::sqrt(glm::dot(along, along));
    const Vec2 out = length > 0.0F ? Vec2(along.y, -along.x) / length : Vec2(1.0F, 0.0F);
    for (int j = 0; j < around; ++j) {
      const double a = kTau * j / around;
      const auto c = static_cast<float>(std::cos(a));
      const auto s = static_cast<float>(std::sin(a));
      const Vec2 p = curve[static_cast<size_t>(i)];
      mesh.positions.emplace_back(p.x * c, p.y, p.x * s);
      mesh.normals.emplace_back(out.x * c, out.y, out.x * s);
      mesh.uvs.emplace_back(static_cast<float>(j) / static_cast<float>(around),
                            static_cast<float>(i) / static_cast<float>(rows - 1));
    }
  }
  for (int i = 0; i + 1 < rows; ++i) {
    for (int j = 0; j < around; ++j) {
      const auto at = [&](int row, int column) {
        return static_cast<uint32_t>(row * around + column % around);
      };
      if (curve[static_cast<size_t>(i)].x > 0.0F) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      }
      if (curve[static_cast<size_t>(i) + 1].x > 0.0F) {
        mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
      }
    }
  }
  return mesh;
}

std::vector<Vec2> round_corners(const std::vector<Corner>& corners, int steps) {
  std::vector<Vec2> profile;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    if (corner.radius <= 0.0F || i == 0 || i + 1 == corners.size()) {
      profile.push_back(corner.at);
      continue;
    }
    const Vec2 back = glm::normalize(corners[i - 1].at - corner.at);
    const Vec2 on = glm::normalize(corners[i + 1].at - corner.at);
    const float half = 0.5F * std::acos(glm::dot(back, on));
    const Vec2 center = corner.at + glm::normalize(back + on) * (corner.radius / std::sin(half));
    const float touch = corner.radius / std::tan(half);
    const Vec2 from = corner.at + back * touch - center;
    const Vec2 to = corner.at + on * touch - center;
    const float turn = std::acos(glm::dot(from, to) / (corner.radius * corner.radius));
    for (int k = 0; k <= steps; ++k) {
      const float u = static_cast<float>(k) / static_cast<float>(steps);
      profile.push_back(center + (from * std::sin((1.0F - u) * turn) + to * std::sin(u * turn)) /
                                     std::sin(turn));
    }
  }
  return profile;
}

}  // namespace hyades::gallery
