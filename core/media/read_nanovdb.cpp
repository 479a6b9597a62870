#include "core/media/read_nanovdb.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/media/nanovdb_tree.h"
#include "core/media/vdb_bricks.h"

namespace hyades::core {
namespace {

/// Offsets in what stands before a grid's tree.
constexpr size_t kClass = 632;
constexpr size_t kMatrix = 384;       ///< 3 x 3 doubles, row by row
constexpr size_t kTranslation = 528;  ///< 3 doubles

constexpr uint32_t kLevelSet = 1;

template <class V>
V read_at(std::span<const std::byte> bytes, size_t place) {
  V value;
  std::memcpy(&value, bytes.data() + place, sizeof(value));
  return value;
}

/// From voxels to the space of the file.
Mat4 map_of(std::span<const std::byte> grid) {
  Mat4 matrix(1.0F);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const size_t place = kMatrix + 8 * static_cast<size_t>(3 * row + column);
      matrix[column][row] = static_cast<float>(read_at<double>(grid, place));
    }
    const size_t place = kTranslation + 8 * static_cast<size_t>(row);
    matrix[3][row] = static_cast<float>(read_at<double>(grid, place));
  }
  return matrix;
}

template <class T>
Result<std::shared_ptr<const VdbGrid<T>>> read_grid(const NanoEntry& entry, const Bytes& file) {
  auto bytes = unpack_nanovdb(entry, file);
  if (!bytes) return bytes.error();
  const std::span<const std::byte> grid = bytes->span();
  if (grid.size() < kNanoGridBytes) return Error{"ends too early"};
  if (read_at<uint32_t>(grid, kClass) == kLevelSet) {
    return Error{"is a level set, expected a fog volume"};
  }
  constexpr size_t kMostBlocks = kMostVdbBytes / 4 / sizeof(typename VdbTree<T>::Block);
  auto tree = read_nanovdb_tree<T>(grid, entry.type, kMostBlocks);
  if (!tree) return tree.error();
  return bricks_of(*tree, map_of(grid));
}

template <class T>
Result<std::shared_ptr<const VdbGrid<T>>> read(const Bytes& bytes, const std::string& name,
                                               const char* expected,
                                               std::initializer_list<NanoType> types) {
  const auto entries = nanovdb_entries(bytes);
  if (!entries) return entries.error();
  std::vector<std::string> names;
  for (const NanoEntry& entry : *entries) {
    if (entry.name != name) {
      if (names.size() < 100) names.push_back(entry.name);
      continue;
    }
    if (std::find(types.begin(), types.end(), entry.type) == types.end()) {
      return Error{"is of type " + name_of(entry.type) + ", expected " + expected}.in("grid '" +
                                                                                      name + "'");
    }
    auto grid = read_grid<T>(entry, bytes);
    if (!grid) return grid.error().in("grid '" + name + "'");
    return *grid;
  }
  return Error{fmt::format("has no grid '{}', expected {}", name,
                           names.empty() ? "one (there is none)" : join_names(names))};
}

}  // namespace

Result<std::shared_ptr<const VdbGrid<float>>> read_nanovdb_numbers(const Bytes& bytes,
                                                                   const std::string& name) {
  return read<float>(bytes, name, "numbers (Float, Double, Fp4, Fp8, Fp16, FpN)",
                     {NanoType::real, NanoType::real64, NanoType::quantized4, NanoType::quantized8,
                      NanoType::quantized16, NanoType::quantized});
}

Result<std::shared_ptr<const VdbGrid<Rgb>>> read_nanovdb_colors(const Bytes& bytes,
                                                                const std::string& name) {
  return read<Rgb>(bytes, name, "colours (Vec3f)", {NanoType::vector});
}

Result<std::vector<std::string>> nanovdb_names(const Bytes& bytes) {
  const auto entries = nanovdb_entries(bytes);
  if (!entries) return entries.error();
  std::vector<std::string> names;
  for (const NanoEntry& entry : *entries) names.push_back(entry.name);
  return names;
}

}  // namespace hyades::core
