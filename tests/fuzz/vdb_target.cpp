// A file of OpenVDB or NanoVDB, of numbers and of colours.

#include "core/media/read_vdb.h"
#include "core/media/write_vdb.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/support/nanovdb_writer.h"

namespace hyades::fuzz {
namespace {

std::string nano(nanovdb::io::Codec codec) {
  openvdb::initialize();
  openvdb::FloatGrid grid(0.0F);
  grid.setName("density");
  grid.fill(openvdb::CoordBBox({0, 0, 0}, {8, 2, 1}), 0.5F);
  std::vector<test::NanoHandle> handles;
  handles.push_back(test::nanovdb_grid<float>(grid));
  return test::nanovdb_file(handles, codec);
}

}  // namespace

std::vector<std::string> seeds() {
  core::VdbBox numbers;
  numbers.name = "density";
  numbers.size = core::Vec3i(9, 3, 2);
  numbers.values.assign(54, 0.5F);
  core::VdbBox colors = numbers;
  colors.colors = true;
  colors.values.assign(162, 0.25F);
  return {written([&] { return core::write_vdb({numbers}); }),
          written([&] { return core::write_vdb({colors}); }), nano(nanovdb::io::Codec::NONE),
          nano(nanovdb::io::Codec::ZIP)};
}

bool try_input(std::string_view input) {
  const core::Bytes bytes = exact_bytes(input);
  const bool numbers = core::read_vdb_numbers(bytes, "density").ok();
  return core::read_vdb_colors(bytes, "density").ok() || numbers;
}

}  // namespace hyades::fuzz
