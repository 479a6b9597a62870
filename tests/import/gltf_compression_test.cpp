// Meshes that are packed: EXT_meshopt_compression, KHR_draco_mesh_compression.

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "tests/import/gltf_builder.h"
#include "tests/support/random.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;

constexpr uint32_t kSide = 12;  ///< vertices of a wavy sheet along each side

struct Sheet {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Sheet sheet() {
  Sheet out;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide);
    const auto y = static_cast<float>(i / kSide);
    out.positions.insert(out.positions.end(), {x, y, 0.25F * x * y});
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    out.indices.insert(out.indices.end(), {i, i + 1, i + kSide, i + kSide, i + 1, i + kSide + 1});
  }
  return out;
}

nlohmann::json packed_view(GltfBuilder& b, const std::vector<unsigned char>& code, size_t count,
                           size_t stride, const char* mode, const char* filter) {
  const int plain = b.view(code.data(), code.size());
  const nlohmann::json at = b.json["bufferViews"][static_cast<size_t>(plain)];
  b.json["bufferViews"].erase(static_cast<size_t>(plain));
  return {{"buffer", 0},
          {"byteLength", count * stride},
          {"extensions",
           {{"EXT_meshopt_compression",
             {{"buffer", 0},
              {"byteOffset", at["byteOffset"]},
              {"byteLength", code.size()},
              {"byteStride", stride},
              {"count", count},
              {"mode", mode},
              {"filter", filter}}}}}};
}

/// The sheet by meshopt's codecs, with normals as octahedra.
GltfBuilder meshopt_sheet() {
  const Sheet s = sheet();
  const size_t n = kSide * kSide;
  GltfBuilder b;
  b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  b.json["bufferViews"] = nlohmann::json::array();
  const auto vertices = [&](const void* data, size_t stride) {
    std::vector<unsigned char> code(meshopt_encodeVertexBufferBound(n, stride));
    code.resize(meshopt_encodeVertexBuffer(code.data(), code.size(), data, n, stride));
    return code;
  };
  const int positions = b.add(
      "bufferViews", packed_view(b, vertices(s.positions.data(), 12), n, 12, "ATTRIBUTES", "NONE"));
  std::vector<float> normals;
  for (size_t i = 0; i < n; ++i) normals.insert(normals.end(), {0.6F, 0, 0.8F, 0});
  std::vector<int8_t> octahedra(4 * n);
  meshopt_encodeFilterOct(octahedra.data(), n, 4, 8, normals.data());
  const int turned = b.add("bufferViews", packed_view(b, vertices(octahedra.data(), 4), n, 4,
                                                      "ATTRIBUTES", "OCTAHEDRAL"));
  std::vector<unsigned char> code(meshopt_encodeIndexBufferBound(s.indices.size(), n));
  code.resize(
      meshopt_encodeIndexBuffer(code.data(), code.size(), s.indices.data(), s.indices.size()));
  const int indices =
      b.add("bufferViews", packed_view(b, code, s.indices.size(), 4, "TRIANGLES", "NONE"));
  b.add("accessors",
        {{"bufferView", positions}, {"componentType", 5126}, {"count", n}, {"type", "VEC3"}});
  b.add("accessors", {{"bufferView", turned},
                      {"componentType", 5120},
                      {"normalized", true},
                      {"count", n},
                      {"type", "VEC3"}});
  b.add("accessors", {{"bufferView", indices},
                      {"componentType", 5125},
                      {"count", s.indices.size()},
                      {"type", "SCALAR"}});
  b.add("nodes",
        {{"mesh", b.mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}})}});
  return b;
}

/// The sheet by Draco.
GltfBuilder draco_sheet() {
  const Sheet s = sheet();
  draco::TriangleSoupMeshBuilder soup;
  const auto faces = static_cast<uint32_t>(s.indices.size() / 3);
  soup.Start(static_cast<int>(faces));
  const int attribute = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (uint32_t f = 0; f < faces; ++f) {
    const float* corner[3];
    for (uint32_t k = 0; k < 3; ++k) corner[k] = &s.positions[size_t{3} * s.indices[3 * f + k]];
    soup.SetAttributeValuesForFace(attribute, draco::FaceIndex(f), corner[0], corner[1], corner[2]);
  }
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer code;
  if (!encoder.EncodeMeshToBuffer(*mesh, &code).ok()) throw std::runtime_error("no Draco");
  GltfBuilder b;
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int view = b.view(code.data(), code.size());
  b.add("accessors", {{"componentType", 5126}, {"count", kSide * kSide}, {"type", "VEC3"}});
  b.add("accessors", {{"componentType", 5125}, {"count", s.indices.size()}, {"type", "SCALAR"}});
  b.add("nodes",
        {{"mesh", b.mesh({{"attributes", {{"POSITION", 0}}},
                          {"indices", 1},
                          {"extensions",
                           {{"KHR_draco_mesh_compression",
                             {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}})}});
  return b;
}

/// The corners of all triangles, in an order of their own.
std::vector<std::array<float, 9>> corners_of(const core::TriangleMesh& mesh) {
  std::vector<std::array<float, 9>> out;
  for (const auto& t : mesh.triangles) {
    // Codecs may begin with any corner of a triangle.
    size_t first = 0;
    const auto before = [&](size_t a, size_t b) {
      const core::Vec3& p = mesh.positions[t[a]];
      const core::Vec3& q = mesh.positions[t[b]];
      return std::tie(p.x, p.y) < std::tie(q.x, q.y);
    };
    for (size_t k = 1; k < 3; ++k) first = before(k, first) ? k : first;
    std::array<float, 9> all{};
    for (size_t k = 0; k < 9; ++k) {
      all[k] = mesh.positions[t[(first + k / 3) % 3]][static_cast<int>(k % 3)];
    }
    out.push_back(all);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::array<float, 9>> expected() {
  const Sheet s = sheet();
  GltfBuilder b;
  const int positions = b.floats(s.positions, "VEC3");
  const int indices = b.accessor(s.indices, "SCALAR");
  b.add("nodes",
        {{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
  return corners_of(*mesh_of(b, "meshes/mesh.ply"));
}

TEST(GltfCompression, MeshoptGivesBackTheSameTriangles) {
  const auto mesh = mesh_of(meshopt_sheet(), "meshes/mesh.ply");
  EXPECT_EQ(corners_of(*mesh), expected());
  for (const core::Vec3& normal : mesh->normals) {
    EXPECT_NEAR(normal.x, 0.6F, 0.01F);
    EXPECT_NEAR(normal.z, 0.8F, 0.01F);
  }
}

TEST(GltfCompression, DracoGivesBackTheSameTriangles) {
  const auto mesh = mesh_of(draco_sheet(), "meshes/mesh.ply");
  const auto found = corners_of(*mesh);
  const auto wanted = expected();
  ASSERT_EQ(found.size(), wanted.size());
  // 14 bits of 30.25, the longest side.
  for (size_t i = 0; i < found.size(); ++i) {
    for (size_t k = 0; k < 9; ++k) EXPECT_NEAR(found[i][k], wanted[i][k], 30.25F / 16383.0F);
  }
}

TEST(GltfCompression, AbsurdCountsAreRefusedBeforeMemoryIsTaken) {
  GltfBuilder b = meshopt_sheet();
  b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 2'000'000'000;
  EXPECT_THAT(job_of(b), HasSubstr("says that"));
  GltfBuilder d = draco_sheet();
  // What follows Draco's header is how many vertices and triangles there are.
  const size_t at = d.json["bufferViews"][0]["byteOffset"].get<size_t>() + 12;
  for (size_t i = 0; i < 8; ++i) d.buffer[at + i] = static_cast<char>(i % 4 == 3 ? 0x07 : 0xFF);
  const auto source = read_glb(d.glb());
  const auto made = (*source)->made_file("meshes/mesh.ply");
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("holds no valid Draco code"));
}

TEST(GltfCompression, MutatedCodeGivesAnErrorOrAMesh) {
  for (const std::string& whole : {meshopt_sheet().glb(), draco_sheet().glb()}) {
    Random random(3);
    int refused = 0;
    const size_t binary = whole.find(std::string("BIN\0", 4)) + 4;
    for (int round = 0; round < 1500; ++round) {
      std::string file = whole;
      const int changes = 1 + static_cast<int>(random.uniform() * 3);
      for (int i = 0; i < changes; ++i) {
        const auto place = random.uniform() * static_cast<float>(file.size() - binary);
        file[binary + static_cast<size_t>(place)] = static_cast<char>(random.uniform() * 256);
      }
      const auto source = read_glb(file);
      refused += source.ok() && (*source)->made_file("meshes/mesh.ply").ok() ? 0 : 1;
    }
    EXPECT_GT(refused, 50);
  }
}

}  // namespace
}  // namespace hyades::test
