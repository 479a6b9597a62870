// A pbrt-v4 scene.

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/scene_target.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  const std::string head =
      "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
      "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n";
  return {head + R"(
LightSource "infinite" "rgb L" [.1 .2 .3]
Texture "t" "float" "fbm" "integer octaves" 4
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 .1 .2]
MakeNamedMaterial "m" "string type" "conductor" "float roughness" .1 "texture displacement" "t"
AttributeBegin NamedMaterial "m" Translate 1 2 3
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] AttributeEnd
ObjectBegin "o" Shape "loopsubdiv" "integer levels" 1 "point3 P" [0 0 0 1 0 0 0 1 0]
"integer indices" [0 1 2] ObjectEnd ObjectInstance "o"
)",
          head + R"(
Texture "s" "spectrum" "checkerboard" "rgb tex1" [.1 .2 .3] "float uscale" 3
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1
"float density" [1 .5] "point3 p0" [0 0 0] "point3 p1" [1 1 1] "blackbody Le" 3000
Material "coateddiffuse" "texture reflectance" "s" MediumInterface "smoke" ""
Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 2 2 2] "float width" .1
AreaLightSource "diffuse" "blackbody L" 3000 Shape "sphere" "float zmin" -.5
ActiveTransform EndTime Rotate 30 0 1 0 ActiveTransform All ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]
Include "a.inc"
)"};
}

bool try_input(std::string_view input) {
  Files files("scene.pbrt", input);
  files.add("a.inc", "Shape \"disk\" \"float radius\" 2\n");
  return try_scene(files, "scene.pbrt");
}

}  // namespace hyades::fuzz
