// The shapes of pbrt's scenes as meshes.

#include "core/geometry/read_hair.h"
#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using core::Vec2;
using core::Vec3;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::shared_ptr<core::TriangleMesh> mesh_in(const std::string& world) {
  const PbrtJob job = pbrt_job(pbrt_world(world));
  EXPECT_EQ(job.error, "");
  return pbrt_mesh(job, "meshes/shape-0.ply");
}

/// Of all triangles, along z.
std::vector<float> facing(const core::TriangleMesh& mesh) {
  std::vector<float> out;
  for (const auto& t : mesh.triangles) {
    const auto& p = mesh.positions;
    out.push_back(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z);
  }
  return out;
}

double area(const core::TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto& p = mesh.positions;
    sum += 0.5 * static_cast<double>(glm::length(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])));
  }
  return sum;
}

constexpr const char* kTriangleMesh = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]";

TEST(PbrtShapes, ReverseOrientationTurnsMeshesInsideOut) {
  EXPECT_THAT(facing(*mesh_in(kTriangleMesh)), ElementsAre(1.0F));
  EXPECT_THAT(facing(*mesh_in(std::string("ReverseOrientation ") + kTriangleMesh)),
              ElementsAre(-1.0F));
}

TEST(PbrtShapes, NormalsSayWhichSideIsTheOuterOne) {
  const auto mesh = mesh_in(std::string(kTriangleMesh) + " \"normal N\" [0 0 -2 0 0 -2 0 0 -2]");
  EXPECT_THAT(facing(*mesh), ElementsAre(-1.0F));
  EXPECT_THAT(mesh->normals, Each(Vec3(0, 0, -1)));
}

TEST(PbrtShapes, BilinearPatchesGoByRows) {
  const auto flat = mesh_in("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]");
  EXPECT_THAT(flat->uvs, ElementsAre(Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)));
  EXPECT_NEAR(area(*flat), 2.0, 1e-6);
  EXPECT_THAT(facing(*flat), Each(2.0F));
  // z = u v over the unit square: the integral of sqrt(1 + u^2 + v^2) is 1.2808.
  const auto bent = mesh_in("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
  EXPECT_EQ(bent->triangles.size(), 128U);
  EXPECT_NEAR(area(*bent), 1.2808, 3e-3);
}

TEST(PbrtShapes, PartsOfSpheresDisksAndCylinders) {
  constexpr double kTurn = 3.14159265358979323846;
  const auto cap = mesh_in("Shape \"sphere\" \"float zmin\" 0 \"float zmax\" .5");
  EXPECT_NEAR(area(*cap), 2.0 * kTurn * 0.5, 5e-3);
  for (size_t i = 0; i < cap->positions.size(); ++i) {
    EXPECT_NEAR(glm::length(cap->positions[i] - cap->normals[i]), 0.0F, 1e-6F);
  }
  const auto inwards = mesh_in("ReverseOrientation Shape \"sphere\"");
  EXPECT_NEAR(glm::length(inwards->positions[500] + inwards->normals[500]), 0.0F, 1e-6F);
  const auto ring = mesh_in(
      "Shape \"disk\" \"float innerradius\" .5 \"float phimax\" 180 "
      "\"float height\" 2");
  EXPECT_NEAR(area(*ring), 0.5 * kTurn * 0.75, 2e-3);
  EXPECT_EQ(ring->positions[0], Vec3(1, 0, 2));
  const auto gutter = mesh_in("Shape \"cylinder\" \"float phimax\" 90 \"float zmax\" 3");
  EXPECT_NEAR(area(*gutter), 0.5 * kTurn * 4.0, 1e-3);
  EXPECT_THAT(pbrt_job(pbrt_world("Shape \"cylinder\"")).text, HasSubstr("caps: false"));
}

TEST(PbrtShapes, LoopSubdivisionNearsItsLimit) {
  // An octahedron with vertices 1 from the middle: by the mask of the limit its corners come to
  // rest at (1 - n w) with w = 1 / (n + 3 / (8 beta)), n = 4, beta = 3 / 32: 1 - 4 / 8.
  const std::string octahedron =
      "Shape \"loopsubdiv\" \"integer levels\" 3 \"point3 P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 "
      "-1] "
      "\"integer indices\" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]";
  const auto mesh = mesh_in(octahedron);
  EXPECT_EQ(mesh->triangles.size(), 8U * 64U);
  EXPECT_NEAR(mesh->positions[0].x, 0.5F, 1e-6F);
  EXPECT_EQ(mesh->positions[0].y, 0.0F);
  // The file's triangles go counter-clockwise seen from outside; pbrt takes the other side.
  EXPECT_LT(mesh->normals[0].x, -0.99F);
  // A border keeps its straight lines.
  const auto square = mesh_in(
      "Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" "
      "[0 0 0 1 0 0 1 1 0 0 1 0] \"integer indices\" [0 1 2 0 2 3]");
  for (const Vec3& p : square->positions) EXPECT_EQ(p.z, 0.0F);
}

/// The strands of a file that a job names.
std::shared_ptr<const core::CurveSet> strands_in(const PbrtJob& job, const std::string& name) {
  const auto bytes = job.source->made_file(name);
  EXPECT_TRUE(bytes.ok()) << (bytes.ok() ? "" : bytes.error().message);
  PbrtFiles files;
  files.add("made.hair", std::string(bytes->chars(), bytes->size()));
  auto strands = core::read_hair(files, "made.hair", core::CurveBasis::bezier, 0);
  EXPECT_TRUE(strands.ok()) << (strands.ok() ? "" : strands.error().message);
  return *strands;
}

// As points of Bezier's, whatever they were, with widths that change evenly along them.
TEST(PbrtShapes, CurvesAreStrands) {
  const PbrtJob job =
      pbrt_job(pbrt_world("Material \"hair\" \"float eumelanin\" .3 \"float beta_n\" .4\n"
                          "Shape \"curve\" \"float width0\" .2 \"float width1\" .1 "
                          "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3]\n"
                          "Shape \"curve\" \"string basis\" \"bspline\" \"float width\" .1 "
                          "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3 0 0 4]\n"
                          "Shape \"sphere\""));
  EXPECT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("curves: meshes/shape-0.hair"));
  EXPECT_THAT(job.text, HasSubstr("basis: bezier"));
  EXPECT_THAT(job.text, HasSubstr("type: hair, eumelanin: 0.3, pheomelanin: 0, radial_roughness: "
                                  "0.4, ior: 1.55, tilt: -2"));
  EXPECT_THAT(job.notes, Contains(HasSubstr("hair on what is no curve")));
  const auto first = strands_in(job, "meshes/shape-0.hair");
  ASSERT_EQ(first->pieces.size(), 1U);
  const core::CurvePiece piece = first->piece(0);
  for (const double u : {0.0, 0.25, 0.5, 1.0}) {
    EXPECT_NEAR(piece.at(u).z, 3.0 * u, 1e-6);
    EXPECT_NEAR(piece.radius_at(u), 0.1 - 0.05 * u, 1e-6);
  }
  // A cubic B-spline of points on a line keeps to the inner of them.
  const auto spline = strands_in(job, "meshes/shape-1.hair");
  ASSERT_EQ(spline->pieces.size(), 2U);
  EXPECT_NEAR(spline->piece(0).at(0.0).z, 1.0, 1e-6);
  EXPECT_NEAR(spline->piece(1).at(1.0).z, 3.0, 1e-6);
}

TEST(PbrtShapes, CurvesThatShineAreTubesAndRibbonsBands) {
  const auto tube = mesh_in(
      "AreaLightSource \"diffuse\"\n"
      "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" .2 "
      "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3]");
  for (size_t i = 0; i < tube->positions.size(); ++i) {
    const Vec3 p = tube->positions[i];
    EXPECT_NEAR(std::hypot(p.x, p.y), 0.1F, 1e-6F);
    EXPECT_GT(glm::dot(tube->normals[i], Vec3(p.x, p.y, 0.0F)), 0.0F);
  }
  const auto ribbon = mesh_in(
      "Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [0 1 0 0 1 0] "
      "\"float width0\" 1 \"float width1\" 3 "
      "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3]");
  EXPECT_NEAR(area(*ribbon), 6.0, 1e-4);
  EXPECT_THAT(pbrt_job(pbrt_world("Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" "
                                  "[0 0 0 0 0 1 0 0 2 0 0 3]"))
                  .error,
              HasSubstr("needs one normal more"));
}

TEST(PbrtShapes, AlphaIsOpacity) {
  PbrtFiles files(pbrt_world(
      "Texture \"leaf\" \"float\" \"imagemap\" \"string filename\" \"leaf.png\"\n"
      "Shape \"sphere\" \"texture alpha\" \"leaf\"\nShape \"disk\" \"texture alpha\" \"leaf\"\n"
      "Shape \"sphere\" \"float alpha\" .25\nShape \"sphere\" \"float alpha\" 1"));
  files.add("leaf.png", "damaged");
  const PbrtJob job = read_pbrt_job(files);
  EXPECT_THAT(job.text, HasSubstr("cutout: {like: diffuse, opacity: leaf}"));
  EXPECT_THAT(job.text, HasSubstr("cutout-2: {like: diffuse, opacity: 0.25}"));
  EXPECT_THAT(job.text, Not(HasSubstr("cutout-3")));
}

TEST(PbrtShapes, ManyCurvesBecomeOneFile) {
  std::string world;
  for (int i = 0; i < 300; ++i) {
    world += "Shape \"curve\" \"float width\" .1 \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 " +
             std::to_string(i + 3) + "]\n";
  }
  const PbrtJob job = pbrt_job(pbrt_world(world));
  EXPECT_THAT(job.text, HasSubstr("meshes/shape-0-to-299.hair"));
  const auto all = strands_in(job, "meshes/shape-0-to-299.hair");
  ASSERT_EQ(all->strand_count(), 300U);
  EXPECT_NEAR(all->piece(299).at(1.0).z, 302.0, 1e-4);
  EXPECT_FALSE(job.source->made_file("meshes/shape-0-to-300.hair").ok());
}

TEST(PbrtShapes, ManySmallOnesBecomeOneMesh) {
  std::string world;
  for (int i = 0; i < 300; ++i) {
    world += "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 0 0 1 0 1 " +
             std::to_string(i + 3) + "]\n";
    if (i == 199) world += "Material \"conductor\"\n";
  }
  const PbrtJob job = pbrt_job(pbrt_world(world));
  EXPECT_THAT(job.text, HasSubstr("meshes/shape-0-to-199.ply"));
  EXPECT_THAT(job.text, HasSubstr("meshes/shape-200-to-299.ply"));
  const auto one = pbrt_mesh(job, "meshes/shape-0.ply");
  const auto all = pbrt_mesh(job, "meshes/shape-0-to-199.ply");
  EXPECT_EQ(all->triangles.size(), 200 * one->triangles.size());
  EXPECT_FALSE(job.source->made_file("meshes/shape-0-to-300.ply").ok());
  EXPECT_FALSE(job.source->made_file("meshes/shape-5-to-3.ply").ok());
}

TEST(PbrtShapes, ReversedPlyFilesAreMadeAnewWhereItMatters) {
  PbrtFiles files(
      pbrt_world("ReverseOrientation Shape \"plymesh\" \"string filename\" \"a.ply\"\n"
                 "Material \"dielectric\" Shape \"plymesh\" \"string filename\" "
                 "\"a.ply\""));
  files.add(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n3 0 1 2\n");
  const PbrtJob job = read_pbrt_job(files);
  EXPECT_THAT(job.text, HasSubstr("mesh: a.ply"));
  EXPECT_THAT(job.text, HasSubstr("mesh: meshes/shape-1.ply"));
  EXPECT_THAT(facing(*pbrt_mesh(job, "meshes/shape-1.ply")), ElementsAre(-1.0F));
}

}  // namespace
}  // namespace hyades::test
