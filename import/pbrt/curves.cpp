#include "import/pbrt/made_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace hyades::core::pbrt {
namespace {

constexpr uint32_t kPieces = 6;              ///< of each segment
constexpr uint32_t kSides = 6;               ///< of a tube
constexpr size_t kMostStrandPoints = 65536;  ///< of the files of strands

/// A curve as cubic Bezier segments.
struct Curve {
  std::vector<std::array<Vec3, 4>> segments;
  std::vector<Vec3> normals;  ///< of a ribbon: one more than segments
  float first_width = 1.0F;
  float last_width = 1.0F;
};

/// A quadratic segment as a cubic one.
std::array<Vec3, 4> raised(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a, glm::mix(a, b, 2.0F / 3.0F), glm::mix(c, b, 2.0F / 3.0F), c};
}

Result<Curve> curve_of(const ShapeEntity& shape, Report& report) {
  ParameterReader reader(shape.parameters, shape.place, report);
  Curve out;
  const float width = reader.number("width", 1.0F);
  out.first_width = reader.number("width0", width);
  out.last_width = reader.number("width1", width);
  const int degree = reader.integer("degree", 3);
  if (degree != 2 && degree != 3) return shape.place.error("curves have degree 2 or 3");
  const std::string basis = reader.text("basis", "bezier");
  if (basis != "bezier" && basis != "bspline") {
    return shape.place.error("the basis of a curve is bezier or bspline, not '" + basis + "'");
  }
  const auto numbers = reader.numbers("point3", "P", 3);
  std::vector<Vec3> p;
  for (size_t i = 0; i < numbers.size(); i += 3) {
    p.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  const auto order = static_cast<size_t>(degree);
  const bool fits =
      basis == "bezier" ? p.size() > order && (p.size() - 1) % order == 0 : p.size() > order;
  if (!fits) {
    return shape.place.error("a " + basis + " curve of degree " + std::to_string(degree) +
                             " cannot have " + format_count(p.size()) + " points");
  }
  const size_t step = basis == "bezier" ? order : 1;
  for (size_t i = 0; i + order < p.size(); i += step) {
    if (basis == "bezier") {
      out.segments.push_back(degree == 2 ? raised(p[i], p[i + 1], p[i + 2])
                                         : std::array<Vec3, 4>{p[i], p[i + 1], p[i + 2], p[i + 3]});
    } else if (degree == 2) {
      out.segments.push_back(
          raised(0.5F * (p[i] + p[i + 1]), p[i + 1], 0.5F * (p[i + 1] + p[i + 2])));
    } else {
      out.segments.push_back(
          {(p[i] + 4.0F * p[i + 1] + p[i + 2]) / 6.0F, (2.0F * p[i + 1] + p[i + 2]) / 3.0F,
           (p[i + 1] + 2.0F * p[i + 2]) / 3.0F, (p[i + 1] + 4.0F * p[i + 2] + p[i + 3]) / 6.0F});
    }
  }
  if (reader.text("type", "flat") == "ribbon") {
    const auto normals = reader.numbers("normal", "N", 3);
    if (normals.size() / 3 != out.segments.size() + 1) {
      return shape.place.error("a ribbon of " + format_count(out.segments.size()) +
                               " segments needs one normal more than that");
    }
    for (size_t i = 0; i < normals.size(); i += 3) {
      out.normals.emplace_back(normals[i], normals[i + 1], normals[i + 2]);
    }
  }
  return out;
}

struct Place3 {
  Vec3 at, along;
};

Place3 place_on(const std::array<Vec3, 4>& p, float u) {
  const float v = 1.0F - u;
  const Vec3 at =
      v * v * v * p[0] + 3.0F * u * v * v * p[1] + 3.0F * u * u * v * p[2] + u * u * u * p[3];
  Vec3 along = v * v * (p[1] - p[0]) + 2.0F * u * v * (p[2] - p[1]) + u * u * (p[3] - p[2]);
  if (!(glm::dot(along, along) > 0.0F)) along = p[3] - p[0];
  return {at, along};
}

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const float length = glm::length(v);
  return length > 0.0F ? v / length : otherwise;
}

/// Triangles between two rows of `across` vertices each, the second row being the last one.
void join_rows(TriangleMesh& mesh, uint32_t across) {
  const auto end = static_cast<uint32_t>(mesh.positions.size());
  const uint32_t first = end - 2 * across;
  for (uint32_t k = 0; k + 1 < across; ++k) {
    const uint32_t a = first + k;
    mesh.triangles.push_back({a, a + 1, a + across + 1});
    mesh.triangles.push_back({a, a + across + 1, a + across});
  }
}

}  // namespace

Result<uint64_t> check_curve(const ShapeEntity& shape, Report& report) {
  auto curve = curve_of(shape, report);
  if (!curve) return curve.error();
  if (is_strand(shape)) return curve->segments.size();
  return uint64_t{2} * kPieces * (curve->normals.empty() ? kSides : 1) * curve->segments.size();
}

bool is_strand(const ShapeEntity& shape) {
  if (shape.type != "curve" || shape.area_light >= 0) return false;
  return std::none_of(shape.parameters.begin(), shape.parameters.end(), [](const ParameterPtr& p) {
    return p->name == "type" && !p->texts.empty() && p->texts[0] == "ribbon";
  });
}

Status append_strand(const ShapeEntity& shape, Report& report, StrandList& strands) {
  auto curve = curve_of(shape, report);
  if (!curve) return curve.error();
  const size_t count = 3 * curve->segments.size() + 1;
  if (count > kMostStrandPoints) {
    return shape.place.error("a curve has " + format_count(count) + " points, expected at most " +
                             format_count(kMostStrandPoints));
  }
  strands.sizes.push_back(static_cast<uint32_t>(count));
  for (size_t i = 0; i < count; ++i) {
    const size_t s = std::min(i / 3, curve->segments.size() - 1);
    const float share = static_cast<float>(i) / static_cast<float>(count - 1);
    strands.points.push_back(curve->segments[s][i - 3 * s]);
    strands.radii.push_back(0.5F * std::lerp(curve->first_width, curve->last_width, share));
  }
  return {};
}

Result<TriangleMesh> curve_mesh(const ShapeEntity& shape, Report& report) {
  auto curve = curve_of(shape, report);
  if (!curve) return curve.error();
  TriangleMesh mesh;
  const auto count = static_cast<float>(curve->segments.size());
  Vec3 side(0.0F);  // turned along with the curve, no more than it must
  for (size_t s = 0; s < curve->segments.size(); ++s) {
    for (uint32_t i = s == 0 ? 0 : 1; i <= kPieces; ++i) {
      const float u = static_cast<float>(i) / kPieces;
      const Place3 place = place_on(curve->segments[s], u);
      const Vec3 along = unit_or(place.along, Vec3(0.0F, 0.0F, 1.0F));
      const float share = (static_cast<float>(s) + u) / count;
      const float radius = 0.5F * std::lerp(curve->first_width, curve->last_width, share);
      if (!curve->normals.empty()) {
        const Vec3 n = unit_or(glm::mix(curve->normals[s], curve->normals[s + 1], u), along);
        const Vec3 across = unit_or(glm::cross(n, along), Vec3(1.0F, 0.0F, 0.0F));
        for (int k = 0; k < 2; ++k) {
          mesh.positions.push_back(place.at + (k == 0 ? -radius : radius) * across);
          mesh.normals.push_back(unit_or(glm::cross(along, across), n));
          mesh.uvs.emplace_back(share, static_cast<float>(k));
        }
        if (mesh.positions.size() > 2) join_rows(mesh, 2);
        continue;
      }
      side -= glm::dot(side, along) * along;
      const Vec3 any = std::abs(along.x) < 0.7F ? Vec3(1.0F, 0.0F, 0.0F) : Vec3(0.0F, 1.0F, 0.0F);
      side = unit_or(side, glm::normalize(glm::cross(along, any)));
      const Vec3 other = glm::cross(along, side);
      for (uint32_t k = 0; k <= kSides; ++k) {
        const float turn = 2.0F * kPi * static_cast<float>(k % kSides) / kSides;
        const Vec3 n = std::cos(turn) * side + std::sin(turn) * other;
        mesh.positions.push_back(place.at + radius * n);
        mesh.normals.push_back(n);
        mesh.uvs.emplace_back(share, static_cast<float>(k) / kSides);
      }
      if (mesh.positions.size() > kSides + 1) join_rows(mesh, kSides + 1);
    }
  }
  for (auto& t : mesh.triangles) {
    const auto& p = mesh.positions;
    const Vec3 face = glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    if (glm::dot(face, mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]) < 0.0F) {
      std::swap(t[1], t[2]);
    }
  }
  return mesh;
}

}  // namespace hyades::core::pbrt
