#include "core/geometry/read_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/shared_assets.h"

namespace hyades::core {
namespace {

/// Serves one file from memory. The bytes end where an overrun is seen by address sanitizers.
class MemoryResolver : public AssetResolver {
 public:
  explicit MemoryResolver(const std::string& text) {
    auto owner = std::make_shared<std::vector<char>>(text.begin(), text.end());
    owner->shrink_to_fit();
    bytes_ = Bytes(owner, std::as_bytes(std::span(*owner)));
  }
  Result<Bytes> open(const std::string&, const std::string&) override { return bytes_; }

 private:
  Bytes bytes_;
};

Result<std::shared_ptr<TriangleMesh>> read_text(const std::string& text) {
  MemoryResolver resolver(text);
  return read_mesh(resolver, "it");
}

std::shared_ptr<TriangleMesh> must_read(const std::string& text) {
  auto mesh = read_text(text);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *mesh : std::make_shared<TriangleMesh>();
}

void expect_error(const std::string& text, const std::string& expected) {
  const auto mesh = read_text(text);
  ASSERT_FALSE(mesh) << text;
  EXPECT_NE(mesh.error().message.find(expected), std::string::npos)
      << "'" << mesh.error().message << "' lacks '" << expected << "'";
  EXPECT_EQ(mesh.error().message.rfind("it: ", 0), 0U) << mesh.error().message;
}

/// Writes binary PLY data in either byte order.
class BinaryWriter {
 public:
  explicit BinaryWriter(bool big_endian) : big_endian_(big_endian) {}
  template <class T>
  BinaryWriter& put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (size_t i = 0; i < sizeof(T); ++i) {
      out_ += bytes[big_endian_ ? sizeof(T) - 1 - i : i];
    }
    return *this;
  }
  const std::string& data() const { return out_; }

 private:
  bool big_endian_;
  std::string out_;
};

std::string binary_header(bool big_endian) {
  return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
         "_endian 1.0\ncomment made by hand\n";
}

using Corners = std::array<uint32_t, 3>;

TEST(ReadPly, AsciiTriangles) {
  const auto mesh = must_read(
      "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty float x\r\n"
      "property float y\r\nproperty float z\r\nelement face 2\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n"
      "0 0 0\r\n1 0 0\r\n0 1 0\r\n+.5e1 -2E0 3.25\r\n3 0 1 2\r\n3 2 1 3\r\n");
  EXPECT_EQ(mesh->name, "it");
  ASSERT_EQ(mesh->positions.size(), 4U);
  EXPECT_EQ(mesh->positions[3], Vec3(5.0F, -2.0F, 3.25F));
  ASSERT_EQ(mesh->triangles.size(), 2U);
  EXPECT_EQ(mesh->triangles[1], (Corners{2, 1, 3}));
  EXPECT_EQ(mesh->bounds.lower, Vec3(0.0F, -2.0F, 0.0F));
  EXPECT_EQ(mesh->bounds.upper, Vec3(5.0F, 1.0F, 3.25F));
  EXPECT_GT(mesh->positions.capacity(), mesh->positions.size());
}

TEST(ReadPly, AnyTypesInAnyOrder) {
  for (const bool big : {false, true}) {
    const std::string header =
        binary_header(big) +
        "element material 1\nproperty float shine\nproperty list uchar double list\n"
        "element vertex 3\nproperty uchar red\nproperty double z\nproperty short x\n"
        "property float ny\nproperty float nx\nproperty float nz\nproperty int8 y\n"
        "property float t\nproperty float s\n"
        "element face 1\nproperty uchar flags\nproperty list uint ushort vertex_index\n"
        "property float weight\nend_header\n";
    BinaryWriter w(big);
    w.put(1.0F).put<uint8_t>(2).put(1.0).put(2.0);
    for (int i = 0; i < 3; ++i) {
      w.put<uint8_t>(9).put(0.5 * i).put<int16_t>(static_cast<int16_t>(-300 * i));
      w.put(2.0F).put(0.0F).put(0.0F).put<int8_t>(static_cast<int8_t>(i * i));
      w.put(0.25F * static_cast<float>(i)).put(0.75F);
    }
    w.put<uint8_t>(1).put<uint32_t>(3).put<uint16_t>(2).put<uint16_t>(0).put<uint16_t>(1);
    w.put(0.5F);
    const auto mesh = must_read(header + w.data());
    ASSERT_EQ(mesh->positions.size(), 3U);
    EXPECT_EQ(mesh->positions[2], Vec3(-600.0F, 4.0F, 1.0F));
    ASSERT_EQ(mesh->normals.size(), 3U);
    EXPECT_EQ(mesh->normals[1], Vec3(0, 1, 0));  // made a unit vector
    ASSERT_EQ(mesh->uvs.size(), 3U);
    EXPECT_EQ(mesh->uvs[2], Vec2(0.75F, 0.5F));
    ASSERT_EQ(mesh->triangles.size(), 1U);
    EXPECT_EQ(mesh->triangles[0], (Corners{2, 0, 1}));
  }
}

TEST(ReadPly, UvNames) {
  for (const auto& [u, v] :
       std::map<std::string, std::string>{{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}) {
    const auto mesh = must_read(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nproperty float " +
        u + "\nproperty float " + v +
        "\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0 1 2\n1 0 0 3 4\n0 1 0 5 6\n3 0 1 2\n");
    ASSERT_EQ(mesh->uvs.size(), 3U) << u;
    EXPECT_EQ(mesh->uvs[2], Vec2(5, 6));
  }
}

TEST(ReadPly, PolygonsInBinary) {
  for (const bool big : {false, true}) {
    BinaryWriter w(big);
    for (const Vec2& p : {Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(1, 0.5F), Vec2(0, 2)}) {
      w.put(p.x).put(p.y).put(0.0F);
    }
    w.put<uint8_t>(3).put<int32_t>(0).put<int32_t>(1).put<int32_t>(2);
    w.put<uint8_t>(5);
    for (int32_t i = 0; i < 5; ++i) w.put(i);
    w.put<uint8_t>(2).put<int32_t>(0).put<int32_t>(1);  // a line: no triangle
    const auto mesh = must_read(binary_header(big) +
                                "element vertex 5\nproperty float x\nproperty float y\n"
                                "property float z\nelement face 3\n"
                                "property list uchar int vertex_indices\nend_header\n" +
                                w.data());
    EXPECT_EQ(mesh->triangles.size(), 4U);
  }
}

TEST(ReadPly, FacesBeforeVertices) {
  const auto mesh = must_read(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "4 0 1 2 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
  EXPECT_EQ(mesh->triangles.size(), 2U);
}

TEST(ReadPly, TriangleStrips) {
  const auto mesh = must_read(
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 0\n6 0 0\n5 1 0\n"
      "8 0 1 2 3 -1 4 5 6\n");
  ASSERT_EQ(mesh->triangles.size(), 3U);
  for (const Corners& t : mesh->triangles) {
    const Vec3 n = glm::cross(mesh->positions[t[1]] - mesh->positions[t[0]],
                              mesh->positions[t[2]] - mesh->positions[t[0]]);
    EXPECT_GT(n.z, 0.0F);
  }
}

TEST(ReadPly, VerticesWithoutFacesAreDropped) {
  const auto mesh = must_read(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "9 9 9\n0 0 0\n8 8 8\n1 0 0\n0 1 0\n3 1 3 4\n");
  ASSERT_EQ(mesh->positions.size(), 3U);
  EXPECT_EQ(mesh->positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh->triangles[0], (Corners{0, 1, 2}));
  EXPECT_EQ(mesh->bounds.upper, Vec3(1, 1, 0));
}

TEST(ReadPly, Errors) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uchar int vertex_indices\n";
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  const auto file = [&](const std::string& body) {
    return ascii + "element vertex 3\n" + xyz + "element face 1\n" + list + "end_header\n" + body;
  };
  expect_error("ply\n", "end_header");
  expect_error("ply\nelement vertex 1\nend_header\n", "line 3: the header has no 'format'");
  expect_error("ply\nformat utf8 1.0\n", "line 2: expected ascii");
  expect_error("ply\nformat ascii 2.0\n", "line 2: expected 'format");
  expect_error(ascii + "elements vertex 1\n", "line 3: unknown header word 'elements'");
  expect_error(ascii + "element vertex many\n", "line 3: the count of element 'vertex'");
  expect_error(ascii + "element vertex 99999999999999999999\n", "count of element 'vertex'");
  expect_error(ascii + "element vertex -3\n", "count of element 'vertex'");
  expect_error(ascii + "property float x\n", "line 3: a property before any element");
  expect_error(ascii + "element vertex 1\nproperty float\n", "line 4: expected 'property");
  expect_error(ascii + "element vertex 1\nproperty half x\n", "line 4: unknown property type");
  expect_error(ascii + "element face 1\nproperty list float int a\n", "line 4: a list's length");
  expect_error(ascii + "element vertex 3\nproperty float x\nelement face 1\n" + list +
                   "end_header\n1 2 3\n3 0 1 2\n",
               "no x, y and z");
  expect_error(ascii + "element vertex 3\n" + xyz + "end_header\n" + three, "no faces");
  expect_error(ascii + "element face 1\n" + list + "end_header\n0\n", "no vertices");
  expect_error(file(three + "3 0 1 3\n"), "line 13: vertex index 3 is out of range");
  expect_error(file(three + "3 0 -1 2\n"), "line 13: vertex index -1 is out of range");
  expect_error(file(three + "3 0 1\n"), "ends too early");
  expect_error(file(three + "3 0 1 x\n"), "line 13: expected a number");
  expect_error(file("0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"), "line 11: expected a number");
  expect_error(file("0 0 0\n1 0 0\n"), "too short");
  expect_error(file("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "position of vertex 1 is not finite");
  expect_error(file("0 0 0\n1 0 0\n0 1 1e99\n3 0 1 2\n"), "position of vertex 2 is not finite");
  expect_error(file(three + "-3 0 1 2\n"), "line 13: a list has a negative length");
  expect_error(file(three + "200 0 1 2\n"), "line 13: the file is too short for a list of 200");
  expect_error(ascii + "element vertex 4000000000\n" + xyz + "end_header\n" + three, "too short");
  expect_error(ascii + "element thing 4000000000\nend_header\n", "too short");
  expect_error(ascii + "element vertex 3\n" + xyz + "element face 1\n" +
                   "property list uchar float vertex_indices\nend_header\n" + three + "3 0 1 2\n",
               "not integers");
  expect_error(ascii + "element vertex 3\n" + xyz + "element face 1\n" +
                   "property list uchar int corners\nend_header\n" + three + "3 0 1 2\n",
               "no list 'vertex_indices'");
}

TEST(ReadPly, NormalsThatAreNoneAreFlat) {
  const auto mesh = read_text(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 nan nan nan\n1 0 0 0 2 0\n0 1 0 0 inf 0\n3 0 1 2\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->normals, (std::vector<Vec3>{Vec3(0.0F), Vec3(0, 1, 0), Vec3(0.0F)}));
}

TEST(ReadPly, BinaryErrors) {
  const std::string layout =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto file = [&](float bad, int32_t index) {
    BinaryWriter w(false);
    w.put(0.0F).put(0.0F).put(0.0F).put(1.0F).put(0.0F).put(0.0F).put(0.0F).put(bad).put(0.0F);
    w.put<uint8_t>(3).put<int32_t>(0).put<int32_t>(1).put(index);
    return binary_header(false) + layout + w.data();
  };
  EXPECT_TRUE(read_text(file(1.0F, 2)));
  expect_error(file(1.0F, 3), "face 0 refers to vertex 3, but there are only 3");
  expect_error(file(1.0F, -1), "face 0 refers to vertex");
  expect_error(file(std::numeric_limits<float>::infinity(), 2),
               "position of vertex 2 is not finite");
  expect_error(file(std::nanf(""), 2), "position of vertex 2 is not finite");
  const std::string whole = file(1.0F, 2);
  for (size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(read_text(whole.substr(0, n))) << n;
}

TEST(ReadObj, FacesOfEveryForm) {
  const auto mesh = must_read(
      "# comment\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\r\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n"
      "vt 0 0\nvt 1 0 0\nvt 0.5\nvn 0 0 2\ng group\nusemtl m\ns 1\n"
      "f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//1 3//1\nf 1/1/1 2/2/1 3/3/1 4/1/1 # end\n"
      "f -4 -3 -2\n  f\t1 \\\n 3 4\nl 1 2\np 1\n");
  EXPECT_EQ(mesh->triangles.size(), 7U);
  ASSERT_EQ(mesh->normals.size(), mesh->positions.size());
  ASSERT_EQ(mesh->uvs.size(), mesh->positions.size());
  const Corners& last = mesh->triangles.back();
  EXPECT_EQ(mesh->positions[last[1]], Vec3(1, 1, 0));
  EXPECT_EQ(mesh->positions[last[2]], Vec3(0, 1, 0));
  const Corners& quad = mesh->triangles[3];
  EXPECT_EQ(mesh->normals[quad[0]], Vec3(0, 0, 1));
  EXPECT_EQ(mesh->uvs[quad[1]], Vec2(1, 0));
  EXPECT_EQ(mesh->uvs[quad[2]], Vec2(0.5F, 0));
  // Corners without normals have none, and take the facet's.
  EXPECT_EQ(mesh->normals[mesh->triangles[0][0]], Vec3(0.0F));
}

TEST(ReadObj, VerticesAreSplitOnlyWhereTheyDiffer) {
  const auto mesh = must_read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n"
      "f 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 2/1 4/1\n");
  EXPECT_EQ(mesh->positions.size(), 5U);
  EXPECT_EQ(mesh->triangles[0][0], mesh->triangles[1][0]);
  EXPECT_NE(mesh->triangles[0][0], mesh->triangles[2][0]);
  EXPECT_EQ(mesh->triangles[0][1], mesh->triangles[2][1]);
}

TEST(ReadObj, UnusedNormalsAndUvsAreNotKept) {
  const auto mesh = must_read("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\n");
  EXPECT_TRUE(mesh->normals.empty());
  EXPECT_TRUE(mesh->uvs.empty());
}

TEST(ReadObj, Errors) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_error("", "no faces");
  expect_error(three, "no faces");
  expect_error("v 0 0\n", "line 1: expected 'v x y z'");
  expect_error("v 0 0 nan\n", "line 1: expected 'v x y z' or");
  expect_error("v 0 0 1e99\n", "line 1: expected 'v x y z' or");
  expect_error("v 0 0 0x\n", "line 1: expected 'v x y z'");
  expect_error(three + "vt\n", "line 4: expected 'vt u v'");
  expect_error(three + "vn 1 2\n", "line 4: expected 'vn x y z'");
  expect_error(three + "f\n", "line 4: a face without corners");
  expect_error(three + "f 1 2 4\n", "line 4: index 4 is out of range: the file has 3 lines of 'v'");
  expect_error(three + "\n\nf 1 2 -4\n",
               "line 6: index -4 is out of range: the file has 3 lines of 'v', 3 of them before");
  expect_error(three + "f 1 2 0\n", "line 4: an index is 0");
  expect_error(three + "f 1 2 three\n", "line 4: expected corners like");
  expect_error(three + "f 1/ 2 3x\n", "line 4: expected corners like");
  expect_error(three + "f 1/1 2/1 3/1\n", "line 4: index 1 is out of range");
  expect_error(three + "f 1//1 2//1 3//1\n", "the file has 0 lines of 'vn'");
  expect_error(three + "f 1 2 99999999999999999999\n", "line 4: expected corners like");
  expect_error(three + "f 1 \\\n2 \\\n3\n# \\\n\nf 1 2 9\n", "line 9: index 9 is out of range");
  expect_error(std::string("\x7f\x45\x4c\x46\0\0", 6), "no mesh file that is known");
}

TEST(ReadObj, OtherTextIsSaidToBeNoMesh) {
  expect_error("root:x:0:0:root:/root:/bin/bash\n",
               "no mesh file that is known; expected OBJ or PLY");
  expect_error("hyades: 1\nfilm: {size: [4, 4]}\n", "no mesh file that is known");
}

TEST(ReadMesh, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const std::string mark = "\xEF\xBB\xBF";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(must_read(mark + obj)->positions.size(), 3U);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(must_read(mark + ply)->triangles.size(), 1U);
}

TEST(ReadObj, TooManyCornersAreRefused) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 20000; ++i) text += " 1 2 3";
  expect_error(text + "\n", "line 4: a face has more than 16384 corners");
}

TEST(ReadObj, LongFilesAreReadInPiecesWithRightLineNumbersAndIndices) {
  // Several pieces, relative indices across their borders, continued lines, then one error.
  std::string text;
  size_t lines = 0;
  const size_t blocks = 40000;
  for (size_t i = 0; i < blocks; ++i) {
    const std::string x = std::to_string(i);
    text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\nf -3 \\\n-2 -1\n";
    lines += 5;
  }
  const auto mesh = must_read(text);
  ASSERT_EQ(mesh->triangles.size(), blocks);
  for (size_t i = 0; i < blocks; i += 997) {
    const Corners& t = mesh->triangles[i];
    EXPECT_EQ(mesh->positions[t[0]], Vec3(static_cast<float>(i), 0, 0));
    EXPECT_EQ(mesh->positions[t[2]], Vec3(static_cast<float>(i), 0, 1));
  }
  expect_error(text + "f 1 2 0\nv nan 0 0\n",
               "line " + std::to_string(lines + 1) + ": an index is 0");
}

/// Files of all kinds, for the tests below.
std::vector<std::string> samples() {
  std::vector<std::string> out;
  const std::string layout =
      "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float u\n"
      "property float v\nelement face 3\nproperty uchar flag\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (const bool big : {false, true}) {
    for (const bool polygons : {false, true}) {
      BinaryWriter w(big);
      for (int i = 0; i < 40; ++i) w.put(0.25F * static_cast<float>(i % 11));
      for (int32_t i = 0; i < 3; ++i) {
        w.put<uint8_t>(0).put<uint8_t>(polygons && i == 1 ? 4 : 3);
        w.put(i).put(i + 1).put(i + 2);
        if (polygons && i == 1) w.put<int32_t>(0);
      }
      out.push_back(binary_header(big) + layout + w.data());
    }
  }
  out.push_back(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 2\n3 0 1 2\n5 0 1 2 3 4\n");
  out.push_back(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n6 0 1 2 -1 2 3\n");
  out.push_back(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
      "f 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1\nf -1 -2 \\\n-3\nf 1//1 2//1 3//1\n");
  return out;
}

/// What a reader promises of every mesh it lets through.
void check_mesh(const TriangleMesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Corners& t : mesh.triangles) {
    for (const uint32_t i : t) ASSERT_LT(i, mesh.positions.size());
  }
  for (const Vec3& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  ASSERT_GT(mesh.positions.capacity(), mesh.positions.size());
}

TEST(ReadMesh, EveryTruncationIsAnErrorOrAMesh) {
  for (const std::string& whole : samples()) {
    ASSERT_TRUE(read_text(whole)) << read_text(whole).error().message;
    for (size_t n = 0; n < whole.size(); ++n) {
      const auto mesh = read_text(whole.substr(0, n));
      if (mesh) check_mesh(**mesh);
    }
  }
}

TEST(ReadMesh, RandomDamageIsAnErrorOrAMesh) {
  test::Random random(1);
  size_t errors = 0;
  size_t meshes = 0;
  for (const std::string& whole : samples()) {
    for (int i = 0; i < 3000; ++i) {
      std::string text = whole;
      const uint64_t flips = 1 + random.bits() % 4;
      for (uint64_t k = 0; k < flips; ++k) {
        char& c = text[random.bits() % text.size()];
        // Bits, whole bytes, or characters that mean something.
        switch (random.bits() % 3) {
          case 0:
            c = static_cast<char>(c ^ (1 << (random.bits() % 8)));
            break;
          case 1:
            c = static_cast<char>(random.bits());
            break;
          default:
            c = "0123456789-/\\\n .e"[random.bits() % 17];
            break;
        }
      }
      const auto mesh = read_text(text);
      if (mesh) check_mesh(**mesh);
      ++(mesh ? meshes : errors);
    }
  }
  EXPECT_GT(errors, 1000U);
  EXPECT_GT(meshes, 1000U);
}

TEST(ReadMesh, ReadsTheScans) {
  const std::string dragon = test::shared_file("assets/meshes/dragon_100k.ply");
  HYADES_SKIP_WITHOUT(dragon);
  const auto files = make_file_resolver("");
  auto mesh = read_mesh(*files, dragon);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 100012U);
  EXPECT_EQ((*mesh)->positions.size(), 49692U);  // 47 of 49739 belong to no face
  mesh = read_mesh(*files, test::shared_file("assets/meshes/bunny_closed_75k.obj"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 75408U);
  mesh = read_mesh(*files, test::shared_file("assets/meshes/teapot.obj"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 6320U);
  mesh = read_mesh(*files, test::shared_file("assets/meshes/igea_tristrips.ply"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->positions.size(), 134345U);
  EXPECT_EQ((*mesh)->triangles.size(), 268686U);
}

}  // namespace
}  // namespace hyades::core
