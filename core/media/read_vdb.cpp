#include "core/media/read_vdb.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/media/read_nanovdb.h"
#include "core/media/vdb_bricks.h"
#include "core/media/vdb_cursor.h"
#include "core/media/vdb_tree.h"

namespace hyades::core {
namespace {

constexpr uint32_t kOldest = 222;  ///< files of OpenVDB 3 (2015) and later
constexpr uint32_t kNewest = 224;

/// What stands before a grid.
struct Entry {
  std::string name;
  std::string type;     ///< "Tree_float_5_4_3"
  bool half = false;    ///< floats stored as halves
  bool copied = false;  ///< shares the tree of another grid
  int64_t end = 0;      ///< of the grid
};

/// The value of "class", if it is among the metadata.
std::string read_metadata(VdbCursor& cursor) {
  std::string grid_class;
  const auto count = cursor.read<uint32_t>();
  for (uint32_t i = 0; i < count && cursor.ok(); ++i) {
    const std::string name = cursor.read_text();
    cursor.read_text();  // type
    if (name == "class") {
      grid_class = cursor.read_text();
    } else {
      cursor.take(cursor.read<uint32_t>());
    }
  }
  return grid_class;
}

/// How many grids there are; whether they say where they end.
struct Header {
  int32_t grids = 0;
  bool has_ends = false;
};

Header read_header(VdbCursor& cursor) {
  Header header;
  if (cursor.read<int64_t>() != 0x56444220) {
    cursor.fail("is neither a file of OpenVDB nor one of NanoVDB");
    return header;
  }
  const auto version = cursor.read<uint32_t>();
  if (version < kOldest || version > kNewest) {
    cursor.fail(fmt::format("has version {} of the OpenVDB format, expected {} to {}", version,
                            kOldest, kNewest));
  }
  cursor.take(2 * sizeof(uint32_t));  // the version of the library
  header.has_ends = cursor.read<uint8_t>() != 0;
  cursor.take(36);  // an identifier
  read_metadata(cursor);
  header.grids = cursor.read<int32_t>();
  return header;
}

Entry read_entry(VdbCursor& cursor) {
  Entry entry;
  entry.name = cursor.read_text();
  // Grids of one name are told apart by what follows a separator.
  entry.name = entry.name.substr(0, entry.name.find('\x1e'));
  entry.type = cursor.read_text();
  constexpr std::string_view kHalf = "_HalfFloat";
  if (entry.type.ends_with(kHalf)) {
    entry.half = true;
    entry.type.resize(entry.type.size() - kHalf.size());
  }
  entry.copied = !cursor.read_text().empty();
  cursor.take(2 * sizeof(int64_t));
  entry.end = cursor.read<int64_t>();
  return entry;
}

std::array<double, 3> read_three(VdbCursor& cursor) {
  std::array<double, 3> three{};
  for (double& x : three) x = cursor.read<double>();
  return three;
}

/// From voxels to the space of the file.
Mat4 read_transform(VdbCursor& cursor) {
  Mat4 matrix(1.0F);
  const std::string map = cursor.read_text();
  const auto read_scale = [&] {
    const auto scale = read_three(cursor);
    for (int a = 0; a < 3; ++a) matrix[a][a] = static_cast<float>(scale[static_cast<size_t>(a)]);
    for (int i = 0; i < 4; ++i) read_three(cursor);  // what follows from it
  };
  const auto read_translation = [&] {
    const auto by = read_three(cursor);
    matrix[3] = Vec4(by[0], by[1], by[2], 1.0F);
  };
  if (map == "AffineMap" || map == "UnitaryMap") {
    // Row by row, of a matrix that vectors stand left of: column by column of ours.
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) matrix[i][j] = static_cast<float>(cursor.read<double>());
    }
  } else if (map == "ScaleMap" || map == "UniformScaleMap") {
    read_scale();
  } else if (map == "TranslationMap") {
    read_translation();
  } else if (map == "ScaleTranslateMap" || map == "UniformScaleTranslateMap") {
    read_translation();
    read_scale();
  } else {
    cursor.fail("has a transform with a perspective, or of an unknown kind");
  }
  return matrix;
}

template <class T>
struct Grid {
  VdbTree<T> tree;
  Mat4 to_file{1.0F};
  bool is_level_set = false;
};

constexpr std::string_view kFloats = "Tree_float_5_4_3";
constexpr std::string_view kDoubles = "Tree_double_5_4_3";
constexpr std::string_view kVectors = "Tree_vec3s_5_4_3";

/// The grid that `entry` announces.
template <class T>
Grid<T> read_grid(VdbCursor& cursor, const Entry& entry) {
  Grid<T> grid;
  VdbEncoding encoding;
  encoding.compression = cursor.read<uint32_t>();
  // NOLINTNEXTLINE(bugprone-sizeof-expression): one where T is float
  encoding.components = sizeof(T) / sizeof(float);
  encoding.component_bytes = entry.type == kDoubles ? 8 : 4;
  encoding.half = entry.half;
  grid.is_level_set = read_metadata(cursor) == "level set";
  grid.to_file = read_transform(cursor);
  if (entry.copied) return grid;
  constexpr size_t kMostBlocks = kMostVdbBytes / 4 / sizeof(typename VdbTree<T>::Block);
  grid.tree = VdbTree<T>::read(cursor, encoding, kMostBlocks);
  return grid;
}

/// Where its grids do not say how long they are, one must be read to come to the next.
void skip_grid(VdbCursor& cursor, const Entry& entry) {
  if (entry.type == kFloats || entry.type == kDoubles) {
    read_grid<float>(cursor, entry);
  } else if (entry.type == kVectors) {
    read_grid<Rgb>(cursor, entry);
  } else {
    cursor.fail("has a grid '" + entry.name + "' of type " + entry.type +
                " and does not say where that ends");
  }
}

/// The grid called `name`, whose type is to be one of `types`.
template <class T>
Result<std::shared_ptr<const VdbGrid<T>>> read(const Bytes& bytes, const std::string& name,
                                               const char* expected,
                                               const std::vector<std::string_view>& types) {
  VdbCursor cursor(bytes);
  const Header header = read_header(cursor);
  std::vector<std::string> names;
  for (int32_t i = 0; i < header.grids && cursor.ok(); ++i) {
    const Entry entry = read_entry(cursor);
    if (!cursor.ok()) break;
    if (entry.name != name) {
      if (names.size() < 100) names.push_back(entry.name);
      if (header.has_ends) cursor.seek(entry.end);
      if (!header.has_ends) skip_grid(cursor, entry);
      continue;
    }
    const auto in_grid = [&](const std::string& what) {
      return Error{what}.in("grid '" + name + "'");
    };
    if (std::find(types.begin(), types.end(), entry.type) == types.end()) {
      return in_grid("is of type " + entry.type + ", expected " + expected);
    }
    if (entry.copied) return in_grid("shares the values of another, which cannot be read");
    const Grid<T> grid = read_grid<T>(cursor, entry);
    if (!cursor.ok()) return in_grid(cursor.error());
    if (grid.is_level_set) return in_grid("is a level set, expected a fog volume");
    auto finished = bricks_of(grid.tree, grid.to_file);
    if (!finished) return in_grid(finished.error().message);
    return *finished;
  }
  if (!cursor.ok()) return Error{cursor.error()};
  return Error{fmt::format("has no grid '{}', expected {}", name,
                           names.empty() ? "one (there is none)" : join_names(names))};
}

}  // namespace

Result<std::shared_ptr<const VdbGrid<float>>> read_vdb_numbers(const Bytes& bytes,
                                                               const std::string& name) {
  if (is_nanovdb(bytes)) return read_nanovdb_numbers(bytes, name);
  return read<float>(bytes, name, "numbers (Tree_float_5_4_3, Tree_double_5_4_3)",
                     {kFloats, kDoubles});
}

Result<std::shared_ptr<const VdbGrid<Rgb>>> read_vdb_colors(const Bytes& bytes,
                                                            const std::string& name) {
  if (is_nanovdb(bytes)) return read_nanovdb_colors(bytes, name);
  return read<Rgb>(bytes, name, "colours (Tree_vec3s_5_4_3)", {kVectors});
}

}  // namespace hyades::core
