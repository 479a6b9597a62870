#pragma once

#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#if __has_include(<nanovdb/tools/CreateNanoGrid.h>)
#include <nanovdb/io/IO.h>
#include <nanovdb/tools/CreateNanoGrid.h>
#else
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#endif
#include <openvdb/openvdb.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hyades::test {

using NanoHandle = nanovdb::GridHandle<nanovdb::HostBuffer>;

/// A grid of OpenVDB as one of NanoVDB, made by NanoVDB itself; `Build` is the kind of its values,
/// for example nanovdb::Fp8.
template <class Build, class Tree>
NanoHandle nanovdb_grid(const openvdb::Grid<Tree>& grid) {
#if __has_include(<nanovdb/tools/CreateNanoGrid.h>)
  return nanovdb::tools::createNanoGrid<openvdb::Grid<Tree>, Build>(grid);
#else
  return nanovdb::openToNanoVDB<nanovdb::HostBuffer, Tree, Build>(grid);
#endif
}

/// The bytes of a .nvdb file that holds `grids`, written by NanoVDB itself.
inline std::string nanovdb_file(const std::vector<NanoHandle>& grids,
                                nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  nanovdb::io::Segment segment(codec);
  for (const NanoHandle& grid : grids) segment.add(grid);
  // It writes what stands before the grids last, and skips its place at first.
  std::stringstream stream(std::string(segment.memUsage(), '\0'), std::ios::in | std::ios::out);
  nanovdb::io::writeGrids(stream, grids, codec);
  return stream.str();
}

/// The bytes of a .nvdb file of grids of numbers, stored as floats.
inline std::string nanovdb_file(const std::vector<openvdb::FloatGrid::Ptr>& grids,
                                nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  std::vector<NanoHandle> handles;
  for (const auto& grid : grids) handles.push_back(nanovdb_grid<float>(*grid));
  return nanovdb_file(handles, codec);
}

}  // namespace hyades::test
