// A file of strands of hair.

#include "core/geometry/read_hair.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  core::StrandList list;
  for (int i = 0; i < 7; ++i) {
    list.points.emplace_back(0.5F * static_cast<float>(i), 1.0F, 0.0F);
    list.radii.push_back(0.25F);
  }
  list.sizes = {2, 5};
  const core::Bytes plain = core::hair_bytes(list);
  list.colors.assign(7, core::Vec3(0.5F));
  const core::Bytes colored = core::hair_bytes(list);
  return {std::string(plain.chars(), plain.size()), std::string(colored.chars(), colored.size())};
}

bool try_input(std::string_view input) {
  Files files("a.hair", input);
  bool read = false;
  for (const auto basis :
       {core::CurveBasis::catmull_rom, core::CurveBasis::bezier, core::CurveBasis::b_spline}) {
    const auto set = core::read_hair(files, "a.hair", basis, 1'000'000);
    if (!set) continue;
    read = true;
    for (uint32_t i = 0; i < (*set)->pieces.size(); ++i) (void)(*set)->color_at(i, 0.5F);
  }
  return read;
}

}  // namespace hyades::fuzz
