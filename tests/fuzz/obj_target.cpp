// An OBJ mesh with an MTL file of its own, through the importer.

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/scene_target.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {
      "mtllib a.mtl\no box\ng side\nusemtl m\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5e-1\n"
      "vt 0 0\nvt 1 1 0\nvn 0 0 1\ns 1\nf 1/1/1 2/2/1 3//1 -1\nusemtl n\nf -4 -3 -2\n",
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n",
      "# lines that go on\nv 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nl 1 2\np 3\nf 1 2 3\n"};
}

bool try_input(std::string_view input) {
  Files files("a.obj", input);
  files.add("a.mtl", "newmtl m\nKd 1 0 0\nnewmtl n\nPm 1\nPr .3\n");
  return try_scene(files, "a.obj");
}

}  // namespace hyades::fuzz
