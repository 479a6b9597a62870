// Scene files that are wrong, on purpose or not: an error with its place, nothing else.

#include <algorithm>
#include <random>
#include <string>

#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& scene) { return pbrt_job(scene).error; }

TEST(PbrtHostile, Blocks) {
  EXPECT_THAT(error_of(pbrt_world("AttributeBegin")),
              HasSubstr("scene.pbrt:5:1: AttributeBegin has no AttributeEnd"));
  EXPECT_THAT(error_of(pbrt_world("AttributeEnd")), HasSubstr("ends nothing"));
  EXPECT_THAT(error_of(pbrt_world("ObjectBegin \"a\" AttributeBegin ObjectEnd")),
              HasSubstr("before the end of what began at scene.pbrt:5:17"));
  EXPECT_THAT(error_of(pbrt_world("ObjectBegin \"a\" ObjectBegin \"b\"")),
              HasSubstr("within an object"));
  EXPECT_THAT(error_of(pbrt_world("ObjectInstance \"a\"")), HasSubstr("there is no object 'a'"));
  EXPECT_THAT(error_of("Film \"rgb\""), HasSubstr("no WorldBegin"));
  EXPECT_THAT(error_of(""), HasSubstr("no WorldBegin"));
  EXPECT_THAT(error_of("Shape \"sphere\" WorldBegin"), HasSubstr("only allowed after WorldBegin"));
  EXPECT_THAT(error_of(pbrt_world("Film \"rgb\"")), HasSubstr("only allowed before WorldBegin"));
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "AttributeBegin ";
  EXPECT_THAT(error_of(pbrt_world(deep)), HasSubstr("nested deeper"));
}

TEST(PbrtHostile, Words) {
  EXPECT_THAT(
      error_of(pbrt_world("Shpae \"sphere\"")),
      HasSubstr("scene.pbrt:5:1: found 'Shpae', expected a directive, did you mean 'Shape'"));
  EXPECT_THAT(error_of(pbrt_world("Shape sphere")),
              HasSubstr("expected a kind of shape in quotes"));
  EXPECT_THAT(error_of(pbrt_world("Translate 1 2")), HasSubstr("expected number 3 of 3"));
  EXPECT_THAT(error_of(pbrt_world("Translate 1 2 nan")), HasSubstr("expected number 3 of 3"));
  EXPECT_THAT(error_of(pbrt_world("Scale 1 0 1")), HasSubstr("cannot be undone"));
  EXPECT_THAT(error_of(pbrt_world("Rotate 30 0 0 0")), HasSubstr("the axis is 0 0 0"));
  EXPECT_THAT(error_of("LookAt 0 0 0 0 0 0 0 1 0"), HasSubstr("say no direction"));
  EXPECT_THAT(error_of(std::string("\0\x01", 2)), HasSubstr("control character"));
  EXPECT_THAT(error_of(pbrt_world("Shape \"spere\"")), HasSubstr("did you mean 'sphere'"));
  EXPECT_THAT(error_of(pbrt_world("Material \"difuse\" Shape \"sphere\"")),
              HasSubstr("did you mean 'diffuse'"));
}

TEST(PbrtHostile, Includes) {
  PbrtFiles files(pbrt_world("Include \"a.pbrt\""));
  files.add("a.pbrt", "\nInclude \"scene.pbrt\"");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("a.pbrt:2:1: 'scene.pbrt' includes itself"));
  files.add("a.pbrt", "Include \"../b.pbrt\"");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("leads out of the folder"));
  files.add("a.pbrt", "Include \"/etc/passwd\"");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("is an absolute path"));
  files.add("a.pbrt", "Include \"b.pbrt\"");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("a.pbrt:1:1: cannot open 'b.pbrt'"));
  files.add("b.pbrt", "Shape \"sphere\"\nShape 3");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("b.pbrt:2:7"));
  files.add("b.pbrt", "AttributeBegin");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("b.pbrt:1:1: AttributeBegin has no"));
  files.add("a.pbrt", "Import \"b.pbrt\"");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("does not end all that it begins"));
  files.add("a.pbrt", "\x1F\x8B\x08 damaged");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("a.pbrt: its packed data is damaged"));
}

TEST(PbrtHostile, AFileMayNotBeIncludedWithoutEnd) {
  // Each level includes the next one a hundred times.
  PbrtFiles files(pbrt_world("Include \"0.pbrt\""));
  for (int level = 0; level < 6; ++level) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "Include \"" + std::to_string(level + 1) + ".pbrt\"\n";
    files.add(std::to_string(level) + ".pbrt", text);
  }
  files.add("6.pbrt", "# nothing");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("files are included"));
}

TEST(PbrtHostile, Meshes) {
  const auto mesh = [](const std::string& more) {
    return error_of(pbrt_world("Shape \"trianglemesh\" " + more));
  };
  EXPECT_THAT(mesh(""), HasSubstr("no positions"));
  EXPECT_THAT(mesh("\"point3 P\" [0 0 0 1]"), HasSubstr("expected a multiple of 3"));
  EXPECT_THAT(mesh("\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]"), HasSubstr("no indices"));
  EXPECT_THAT(mesh("\"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]"),
              HasSubstr("index 3 is none of the mesh's 3 vertices"));
  EXPECT_THAT(mesh("\"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 -1]"),
              HasSubstr("index -1"));
  EXPECT_THAT(mesh("\"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0]"),
              HasSubstr("3 positions and 1 uvs"));
  EXPECT_THAT(error_of(pbrt_world("Shape \"loopsubdiv\" \"integer levels\" 40 \"point3 P\" "
                                  "[0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]")),
              HasSubstr("more than 67,108,864 triangles"));
  EXPECT_THAT(error_of(pbrt_world("Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
                                  "\"integer indices\" [0 1 2 0 1 2 1 0 2]")),
              HasSubstr("more than two triangles"));
  EXPECT_THAT(error_of(pbrt_world("Shape \"curve\" \"point3 P\" [0 0 0 1 0 0]")),
              HasSubstr("cannot have 2 points"));
}

std::string repeated(const std::string& piece, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += piece;
  return all;
}

/// One error of a scene whose meshes are too large together.
void expect_too_much(const std::string& world) {
  const std::string error = error_of(pbrt_world(world));
  EXPECT_THAT(error, HasSubstr("the meshes that are made of the scene up to here have more than"));
  EXPECT_THAT(error, Not(HasSubstr("\n")));
}

/// A short line may ask for millions of triangles, and for the same list again.
TEST(PbrtHostile, MeshesThatAreTooLargeTogether) {
  const std::string four =
      "\"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1] \"integer indices\" "
      "[0 1 2 0 2 3 0 3 1 1 3 2] ";
  const std::string levels = "Shape \"loopsubdiv\" " + four + "\"integer levels\" ";
  EXPECT_EQ(error_of(pbrt_world(levels + "11")), "");
  expect_too_much(levels + "12");
  expect_too_much(repeated(levels + "9\n", 40));
  // A single triangle needs no indices, and counts all the same.
  EXPECT_THAT(error_of(pbrt_world("Shape \"loopsubdiv\" \"integer levels\" 2000000000 "
                                  "\"point3 P\" [0 0 0 1 0 0 0 1 0]")),
              HasSubstr("more than 67,108,864 triangles"));
  std::string parts;
  for (int i = 0; i < 1000; ++i) parts += "Shape \"sphere\" \"float phimax\" 350\n";
  EXPECT_EQ(error_of(pbrt_world(parts)), "");
  expect_too_much(repeated(parts, 20));
  std::string points;
  for (int i = 0; i < 3000; ++i) points += "0 " + std::to_string(i) + " 1 ";
  const std::string shared = "Attribute \"shape\" \"point3 P\" [" + points +
                             "] \"integer indices\" [" + repeated("0 1 2 ", 3000) + "]\n";
  expect_too_much(shared + repeated("Shape \"trianglemesh\"\n", 20'000));
  const std::string wrong = error_of(pbrt_world(shared + repeated("Shape \"loopsubdiv\"\n", 99)));
  EXPECT_EQ(std::count(wrong.begin(), wrong.end(), '\n'), 19);
}

/// A mesh that is turned over is made anew for each shape.
TEST(PbrtHostile, AFileThatIsTurnedOverVeryOften) {
  PbrtFiles files(pbrt_world("ReverseOrientation Material \"dielectric\"\n" +
                             repeated("Shape \"plymesh\" \"string filename\" \"a.ply\"\n", 1000)));
  files.add("a.ply", std::string(1'000'000, ' '));
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("the meshes that are made of the scene"));
}

/// Files count once, however often they are included.
TEST(PbrtHostile, IncludedFilesMakeNoRoom) {
  PbrtFiles files(pbrt_world(repeated("Include \"a.pbrt\"\n", 2000)));
  files.add("a.pbrt", "Shape \"sphere\" \"float phimax\" 350\n" + std::string(10'000, ' '));
  EXPECT_THAT(read_pbrt_job(files).error,
              HasSubstr("the meshes that are made of the scene up to here have more than"));
}

/// Each shape has all attributes.
TEST(PbrtHostile, AttributesWithoutEnd) {
  std::string same;
  std::string others;
  for (int i = 0; i < 100'000; ++i) {
    same += "Attribute \"shape\" \"float radius\" " + std::to_string(i % 7 + 1) + "\n";
    others += "\"float a" + std::to_string(i) + "\" 1 ";
  }
  const PbrtJob job = pbrt_job(pbrt_world(same + repeated("Shape \"sphere\"\n", 20'000)));
  EXPECT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("sphere-20000:\n    shape: sphere\n    radius: 5\n"));
  EXPECT_EQ(error_of(pbrt_world("Attribute \"shape\" " + others)),
            "scene.pbrt:5:1: 'shape' has more than 256 attributes here");
  EXPECT_EQ(pbrt_job(pbrt_world("Shape \"sphere\" " + others)).notes.size(), 1001U);
}

TEST(PbrtHostile, ThingsThatAreNotThere) {
  EXPECT_THAT(error_of(pbrt_world("NamedMaterial \"a\" Shape \"sphere\"")),
              HasSubstr("there is no material 'a'"));
  EXPECT_THAT(error_of(pbrt_world("Material \"diffuse\" \"texture reflectance\" \"t\" "
                                  "Shape \"sphere\"")),
              HasSubstr("there is no texture 't' of type spectrum"));
  EXPECT_THAT(error_of(pbrt_world("MediumInterface \"m\" \"\" Shape \"sphere\"")),
              HasSubstr("there is no medium 'm'"));
  EXPECT_THAT(error_of(pbrt_world("LightSource \"point\" \"spectrum I\" \"no.spd\"")),
              HasSubstr("cannot open 'no.spd'"));
  EXPECT_THAT(
      error_of(pbrt_world("MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string "
                          "materials\" [\"a\" \"a\"] NamedMaterial \"a\" Shape \"sphere\"")),
      HasSubstr("material 'a' is made of itself"));
  EXPECT_THAT(error_of(pbrt_world("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\" "
                                  "Material \"diffuse\" \"texture reflectance\" \"t\" "
                                  "Shape \"sphere\"")),
              HasSubstr("made of itself"));
}

TEST(PbrtHostile, LongChainsEndWithAnError) {
  std::string textures = "Texture \"t0\" \"spectrum\" \"constant\" \"rgb value\" [.5 .5 .5]\n";
  std::string mixes = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
  constexpr int kLength = 50'000;
  for (int i = 1; i <= kLength; ++i) {
    const std::string before = std::to_string(i - 1);
    const std::string now = std::to_string(i);
    textures +=
        "Texture \"t" + now + "\" \"spectrum\" \"scale\" \"texture tex\" \"t" + before + "\"\n";
    mixes += "MakeNamedMaterial \"m" + now +
             "\" \"string type\" \"mix\" \"string materials\" [\"m" + before + "\" \"m0\"]\n";
  }
  const std::string last = std::to_string(kLength);
  EXPECT_THAT(error_of(pbrt_world(textures + "Material \"diffuse\" \"texture reflectance\" \"t" +
                                  last + "\" Shape \"sphere\"")),
              HasSubstr("more than 32 in a row"));
  EXPECT_THAT(error_of(pbrt_world(mixes + "NamedMaterial \"m" + last + "\" Shape \"sphere\"")),
              HasSubstr("more than 32 in a row"));
}

TEST(PbrtHostile, ValuesThatNoJobHas) {
  const auto sphere_of = [](const std::string& material) {
    return error_of(pbrt_world("Material " + material + " Shape \"sphere\""));
  };
  EXPECT_THAT(sphere_of("\"diffuse\" \"rgb reflectance\" [2 .5 .5]"),
              HasSubstr("parameter 'reflectance': found a colour above 1"));
  EXPECT_THAT(sphere_of("\"dielectric\" \"float eta\" 0"),
              HasSubstr("an index of refraction lies between 0.01 and 100"));
  for (const std::string light : {"point", "spot", "infinite", "goniometric"}) {
    EXPECT_THAT(error_of(pbrt_world("LightSource \"" + light + "\" \"float scale\" -1")),
                HasSubstr("a light's scale is below 0"));
  }
  EXPECT_THAT(error_of(pbrt_world("LightSource \"spot\" \"float coneangle\" 190")),
              HasSubstr("coneangle is above 0 and at most 180"));
  EXPECT_THAT(error_of(pbrt_world("LightSource \"projection\" \"string filename\" \"a.png\" "
                                  "\"float fov\" 190")),
              HasSubstr("fov is above 0 and below 180"));
}

TEST(PbrtHostile, WhatFailedIsToldOnce) {
  const std::string error = error_of(pbrt_world(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"missing.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\" \"string name\" \"b\" Shape \"sphere\""));
  EXPECT_THAT(error, HasSubstr("missing.png"));
  EXPECT_THAT(error, Not(HasSubstr("made of itself")));
}

/// Enough of object "o" for a file of places.
std::string many_instances() {
  std::string text;
  for (int i = 0; i < 66; ++i) text += "Translate 0 0 1 ObjectInstance \"o\"\n";
  return text;
}

/// Any damage gives a scene or an error, in bounded time.
TEST(PbrtHostile, MutatedFiles) {
  const std::string scene = pbrt_world(R"(
LightSource "infinite" "rgb L" [.1 .2 .3]
Texture "t" "float" "fbm" "integer octaves" 4
Texture "s" "spectrum" "checkerboard" "rgb tex1" [.1 .2 .3] "float uscale" 3
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 .1 .2]
MakeNamedMaterial "m" "string type" "conductor" "float roughness" .1 "texture displacement" "t"
AttributeBegin NamedMaterial "m" Translate 1 2 3
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] AttributeEnd
ObjectBegin "o" Shape "loopsubdiv" "integer levels" 1 "point3 P" [0 0 0 1 0 0 0 1 0]
"integer indices" [0 1 2] ObjectEnd ObjectInstance "o"
)" + many_instances() + R"(
Material "coateddiffuse" "texture reflectance" "s" MediumInterface "fog" ""
Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 2 2 2] "float width" .1
AreaLightSource "diffuse" "blackbody L" 3000 Shape "sphere" "float zmin" -.5
)");
  ASSERT_EQ(error_of(scene), "");
  std::mt19937 random(7);
  const std::string letters = "0123456789.-+e \"[]#ABCabc\\\n";
  for (int round = 0; round < 2500; ++round) {
    std::string damaged = scene;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < changes; ++i) {
      const size_t at = random() % damaged.size();
      switch (random() % 4) {
        case 0:
          damaged[at] = letters[random() % letters.size()];
          break;
        case 1:
          damaged.erase(at, 1 + random() % 20);
          break;
        case 2:
          damaged.insert(at, damaged.substr(random() % damaged.size(), random() % 40));
          break;
        default:
          damaged[at] = static_cast<char>(random());
          break;
      }
    }
    const PbrtJob job = pbrt_job(damaged);
    if (job.source == nullptr) continue;
    for (const char* name :
         {"meshes/shape-0.ply", "meshes/shape-1.ply", "meshes/shape-2.ply", "meshes/object-0-0.ply",
          "places/object-0.ply", "sky.exr", "meshes/shape-99999999999.ply"}) {
      if (job.error.empty()) (void)job.source->made_file(name);
    }
  }
}

}  // namespace
}  // namespace hyades::test
