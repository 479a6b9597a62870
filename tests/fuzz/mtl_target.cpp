// The materials of an OBJ mesh.

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/scene_target.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {
      "newmtl m\nKa .1 .1 .1\nKd .8 .2 .1\nKs 1 1 1\nNs 250\nd .5\nTr .1\nTf 1 .9 .8\nNi 1.5\n"
      "illum 7\nKe 2 2 2\n",
      "newmtl m\nmap_Kd -s 2 2 1 -o .1 0 0 -clamp on a.png\nbump -bm .3 b.png\nPr .4\nPm 1\n"
      "Ps .1\nPc .5\nPcr .1\naniso .3\nanisor .2\nnorm n.png\nmap_d c.png\n",
      "newmtl n\nKd spectral a.rfl 1\nnewmtl m\nKd xyz .3 .3 .3\nrefl -type sphere s.hdr\n"};
}

bool try_input(std::string_view input) {
  Files files("a.obj",
              "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nusemtl n\nf 3 2 1\n");
  files.add("a.mtl", input);
  return try_scene(files, "a.obj");
}

}  // namespace hyades::fuzz
