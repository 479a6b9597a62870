#pragma once

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>
#include <string>

namespace hyades::test {

/// The bytes of a .vdb file that holds `grids`.
inline std::string vdb_file(const openvdb::GridCPtrVec& grids) {
  openvdb::initialize();
  std::ostringstream stream;
  openvdb::io::Stream(stream).write(grids);
  return stream.str();
}

/// A fog volume called `name` with `value(i, j, k)` at the voxels of a box of `n`^3, `voxel` long,
/// the first of them at `from` of the file's space.
template <class Grid, class Value>
typename Grid::Ptr vdb_box(const std::string& name, int n, double voxel, const openvdb::Vec3d& from,
                           const Value& value) {
  openvdb::initialize();
  auto grid = Grid::create();
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  transform->postTranslate(from);
  grid->setTransform(transform);
  auto accessor = grid->getAccessor();
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) accessor.setValue({i, j, k}, value(i, j, k));
    }
  }
  return grid;
}

}  // namespace hyades::test
