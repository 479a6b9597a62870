#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/mesh_source.h"
#include "core/geometry/ply_columns.h"
#include "core/geometry/ply_header.h"
#include "core/geometry/ply_layout.h"
#include "core/geometry/ply_source.h"

namespace hyades::core {
namespace {

constexpr uint32_t kMaxVertices = std::numeric_limits<int32_t>::max();

/// Reads the data of one file into a mesh.
template <class Source>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Source source) : header_(header), source_(source) {}

  Result<std::shared_ptr<TriangleMesh>> read() {
    mesh_ = std::make_shared<TriangleMesh>();
    for (const PlyElement& e : header_.elements) {
      if (e.name == "vertex") vertex_count_ = e.count;
    }
    bool has_vertices = false;
    bool has_faces = false;
    for (const PlyElement& e : header_.elements) {
      if (Status s = check_count(e); !s) return s.error();
      Status s;
      if (e.name == "vertex" && !has_vertices) {
        s = read_vertices(e);
        has_vertices = true;
      } else if (e.name == "face" || e.name == "tristrips") {
        s = read_faces(e);
        has_faces = true;
      } else if (!has_vertices || !has_faces) {
        s = skip_rows(e);
      }
      if (!s) return s.error().in("element '" + e.name + "'");
    }
    if (!has_vertices) return Error{"it has no vertices"};
    triangulate_all(mesh_->positions, polygons_.corners, polygons_.sizes, mesh_->triangles);
    if (Status s = complete_mesh(*mesh_); !s) return s.error();
    return std::move(mesh_);
  }

 private:
  Status check_count(const PlyElement& e) const {
    const size_t least = e.least_row(Source::kText);
    if (e.count == 0) return {};
    if (e.count > kMaxVertices) return too_many(e);
    // In text the last value needs no space after it.
    if (least == 0 || e.count > (source_.left() + 1) / least) return too_many(e);
    return {};
  }

  Error too_many(const PlyElement& e) const {
    return source_.error("the file is too short for " + std::to_string(e.count) + " of element '" +
                         e.name + "'");
  }

  Status read_vertices(const PlyElement& e) {
    auto layout = ply_layout(e);
    if (!layout) return layout.error();
    const size_t n = e.count;
    mesh_->positions.reserve(n + 1);
    mesh_->positions.resize(n);
    if (layout->has_normals) mesh_->normals.resize(n);
    if (layout->has_uvs) mesh_->uvs.resize(n);
    if (layout->has_second_uvs) mesh_->second_uvs.resize(n);
    if (layout->has_colors) mesh_->colors.resize(n);
    if (layout->has_tangents) mesh_->vertex_tangents.resize(n);
    if constexpr (!Source::kText) {
      if (!e.has_lists()) return read_fixed_vertices(e, *layout);
    }
    for (size_t i = 0; i < n; ++i) {
      PlyRow row = layout->defaults;
      for (size_t k = 0; k < e.properties.size(); ++k) {
        float value = 0.0F;
        const PlyProperty& p = e.properties[k];
        if (p.is_list) {
          if (Status s = skip_list(p); !s) return s;
        } else if (!source_.number(p.type, value)) {
          return source_.truncated().in("row " + std::to_string(i));
        }
        const PlySlot slot = layout->slots[k];
        if (slot == kIgnored) continue;
        const bool color = slot >= kRed && slot <= kAlpha;
        row[static_cast<size_t>(slot)] = color ? ply_color(p.type, slot, value) : value;
      }
      store(i, row);
    }
    return {};
  }

  void store(size_t i, const PlyRow& row) {
    mesh_->positions[i] = {row[kX], row[kY], row[kZ]};
    if (!mesh_->normals.empty()) mesh_->normals[i] = {row[kNx], row[kNy], row[kNz]};
    if (!mesh_->uvs.empty()) mesh_->uvs[i] = {row[kU], row[kV]};
    if (!mesh_->second_uvs.empty()) mesh_->second_uvs[i] = {row[kSecondU], row[kSecondV]};
    if (!mesh_->colors.empty()) {
      mesh_->colors[i] = {row[kRed], row[kGreen], row[kBlue], row[kAlpha]};
    }
    if (!mesh_->vertex_tangents.empty()) {
      mesh_->vertex_tangents[i] = {row[kTx], row[kTy], row[kTz], row[kTw]};
    }
  }

  /// Rows of one size: read in parallel.
  Status read_fixed_vertices(const PlyElement& e, const PlyLayout& layout) {
    const PlyColumns columns(e, layout);
    if (e.count > source_.left() / columns.stride()) return source_.truncated();
    const char* data = source_.at();
    for_chunks(e.count, [&](size_t begin, size_t end) {
      const PlyRows rows{data, begin, end};
      const auto read = [&]<size_t N>(const std::array<PlySlot, N>& slots, auto& values) {
        if (!values.empty()) columns.read<Source::kSwap>(rows, slots, &values[0][0]);
      };
      read(std::array{kX, kY, kZ}, mesh_->positions);
      read(std::array{kNx, kNy, kNz}, mesh_->normals);
      read(std::array{kU, kV}, mesh_->uvs);
      read(std::array{kSecondU, kSecondV}, mesh_->second_uvs);
      read(std::array{kRed, kGreen, kBlue, kAlpha}, mesh_->colors);
      read(std::array{kTx, kTy, kTz, kTw}, mesh_->vertex_tangents);
    });
    source_.skip(e.count * columns.stride());
    return {};
  }

  Status read_faces(const PlyElement& e) {
    const bool strips = e.name == "tristrips";
    const auto is_corners = [](const PlyProperty& p) {
      return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    const auto corners = std::find_if(e.properties.begin(), e.properties.end(), is_corners);
    if (corners == e.properties.end()) return Error{"it has no list 'vertex_indices'"};
    if (!is_integer(corners->type)) return Error{"its vertex indices are not integers"};
    if constexpr (!Source::kText) {
      if (!strips && read_fixed_triangles(e)) return {};
      if (!strips && one_list(e) != nullptr) return read_listed_polygons(e);
    }
    for (size_t i = 0; i < e.count; ++i) {
      for (const PlyProperty& p : e.properties) {
        Status s = &p != &*corners ? skip_value(p) : strips ? read_strip(p) : read_polygon(p);
        if (!s) return s.error().in("row " + std::to_string(i));
      }
    }
    return {};
  }

  /// The usual case, faces that are all triangles with no other lists: read in parallel. False
  /// (and nothing is read) where it is not so.
  bool read_fixed_triangles(const PlyElement& e) {
    size_t stride = 0;
    size_t offset = 0;
    const PlyProperty* list = nullptr;
    for (const PlyProperty& p : e.properties) {
      if (!p.is_list) {
        stride += size_of(p.type);
        continue;
      }
      if (list != nullptr) return false;
      list = &p;
      offset = stride;
      stride += size_of(p.count_type) + 3 * size_of(p.type);
    }
    if (e.count == 0 || e.count > source_.left() / stride) return false;
    if (!polygons_.sizes.empty() || !mesh_->triangles.empty()) return false;
    const char* data = source_.at() + offset;
    const size_t first = size_of(list->count_type);
    const size_t step = size_of(list->type);
    const bool plain = step == sizeof(uint32_t) && !Source::kSwap;
    mesh_->triangles.resize(e.count);
    std::atomic<bool> fits{true};
    for_chunks(e.count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const char* row = data + i * stride;
        if (load_as<int64_t, Source::kSwap>(list->count_type, row) != 3) {
          fits = false;
          return;
        }
        // Negative ones become too large, which the check of all indices finds.
        if (plain) {
          std::memcpy(mesh_->triangles[i].data(), row + first, 3 * sizeof(uint32_t));
          continue;
        }
        for (size_t k = 0; k < 3; ++k) {
          const auto index = load_as<int64_t, Source::kSwap>(list->type, row + first + k * step);
          mesh_->triangles[i][k] = static_cast<uint32_t>(index);
        }
      }
    });
    if (!fits) {
      mesh_->triangles.clear();
      return false;
    }
    source_.skip(e.count * stride);
    return true;
  }

  /// The list of an element that has no other; null where it has several.
  static const PlyProperty* one_list(const PlyElement& e) {
    const PlyProperty* list = nullptr;
    for (const PlyProperty& p : e.properties) {
      if (!p.is_list) continue;
      if (list != nullptr) return nullptr;
      list = &p;
    }
    return list;
  }

  /// Faces of all sizes, where nothing else has one.
  Status read_listed_polygons(const PlyElement& e) {
    const PlyProperty* list = one_list(e);
    size_t before = 0;
    size_t after = 0;
    for (const PlyProperty& p : e.properties) {
      if (!p.is_list) (&p < list ? before : after) += size_of(p.type);
    }
    const size_t length_bytes = size_of(list->count_type);
    const size_t step = size_of(list->type);
    // At least three corners each, as far as there is room for them.
    polygons_.sizes.reserve(polygons_.sizes.size() + e.count);
    polygons_.corners.reserve(polygons_.corners.size() +
                              std::min<size_t>(4 * e.count, source_.left() / step));
    for (size_t i = 0; i < e.count; ++i) {
      if (source_.left() < before + length_bytes) return at_row(i, source_.truncated());
      source_.skip(before);
      const auto count = load_as<int64_t, Source::kSwap>(list->count_type, source_.at());
      source_.skip(length_bytes);
      if (count < 0) return at_row(i, source_.error("a list has a negative length"));
      const auto corners = static_cast<size_t>(count);
      if (corners > (source_.left() + 1) / step) {
        return at_row(
            i, source_.error("the file is too short for a list of " + std::to_string(corners)));
      }
      if (corners > kMaxCorners) return at_row(i, too_many_corners(corners));
      for (size_t k = 0; k < corners; ++k) {
        if (source_.left() < step) return at_row(i, source_.truncated());
        const auto index = load_as<int64_t, Source::kSwap>(list->type, source_.at());
        source_.skip(step);
        if (index < 0 || static_cast<uint64_t>(index) >= vertex_count_) {
          return at_row(i, out_of_range(index));
        }
        polygons_.corners.push_back(static_cast<uint32_t>(index));
      }
      polygons_.sizes.push_back(static_cast<uint32_t>(corners));
      if (source_.left() < after) return at_row(i, source_.truncated());
      source_.skip(after);
    }
    return {};
  }

  static Error at_row(size_t row, const Error& error) {
    return error.in("row " + std::to_string(row));
  }

  Error too_many_corners(size_t count) const {
    return source_.error("a face has " + std::to_string(count) + " corners; at most " +
                         std::to_string(kMaxCorners) + " are possible");
  }

  Error out_of_range(int64_t index) const {
    return source_.error("vertex index " + std::to_string(index) + " is out of range: there are " +
                         std::to_string(vertex_count_) + " vertices");
  }

  /// The length of a list, checked against what is left of the file.
  Result<size_t> list_length(const PlyProperty& p) {
    int64_t count = 0;
    if (!source_.integer(p.count_type, count)) return source_.truncated();
    const size_t least = Source::kText ? 2 : size_of(p.type);
    if (count < 0) return source_.error("a list has a negative length");
    if (static_cast<uint64_t>(count) > (source_.left() + 1) / least) {
      return source_.error("the file is too short for a list of " + std::to_string(count));
    }
    return static_cast<size_t>(count);
  }

  Status skip_value(const PlyProperty& p) {
    if (p.is_list) return skip_list(p);
    float ignored = 0.0F;
    if (!source_.number(p.type, ignored)) return source_.truncated();
    return {};
  }

  Status skip_list(const PlyProperty& p) {
    const auto count = list_length(p);
    if (!count) return count.error();
    float ignored = 0.0F;
    for (size_t i = 0; i < *count; ++i) {
      if (!source_.number(p.type, ignored)) return source_.truncated();
    }
    return {};
  }

  Status skip_rows(const PlyElement& e) {
    for (size_t i = 0; i < e.count; ++i) {
      for (const PlyProperty& p : e.properties) {
        if (Status s = skip_value(p); !s) return s.error().in("row " + std::to_string(i));
      }
    }
    return {};
  }

  Result<uint32_t> read_corner(const PlyProperty& p) {
    int64_t index = 0;
    if (!source_.integer(p.type, index)) return source_.truncated();
    if (index < 0 || static_cast<uint64_t>(index) >= vertex_count_) {
      return out_of_range(index);
    }
    return static_cast<uint32_t>(index);
  }

  Status read_polygon(const PlyProperty& p) {
    const auto count = list_length(p);
    if (!count) return count.error();
    if (*count > kMaxCorners) return too_many_corners(*count);
    for (size_t i = 0; i < *count; ++i) {
      const auto corner = read_corner(p);
      if (!corner) return corner.error();
      polygons_.corners.push_back(*corner);
    }
    polygons_.sizes.push_back(static_cast<uint32_t>(*count));
    return {};
  }

  /// Strips of triangles, -1 between them; every other triangle of a strip turns the other way.
  Status read_strip(const PlyProperty& p) {
    const auto count = list_length(p);
    if (!count) return count.error();
    std::array<uint32_t, 2> last{};
    size_t length = 0;
    for (size_t i = 0; i < *count; ++i) {
      int64_t index = 0;
      if (!source_.integer(p.type, index)) return source_.truncated();
      if (index == -1) {
        length = 0;
        continue;
      }
      if (index < 0 || static_cast<uint64_t>(index) >= vertex_count_) {
        return out_of_range(index);
      }
      const auto corner = static_cast<uint32_t>(index);
      if (length >= 2) {
        const bool odd = length % 2 == 1;
        add_strip_triangle({odd ? last[1] : last[0], odd ? last[0] : last[1], corner});
      }
      last = {last[1], corner};
      ++length;
    }
    return {};
  }

  /// Strips repeat vertices to turn corners; those triangles are left out.
  void add_strip_triangle(const std::array<uint32_t, 3>& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
    polygons_.corners.insert(polygons_.corners.end(), t.begin(), t.end());
    polygons_.sizes.push_back(3);
  }

  const PlyHeader& header_;
  Source source_;
  uint64_t vertex_count_ = 0;
  std::shared_ptr<TriangleMesh> mesh_;
  PolygonList polygons_;
};

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_ply(std::span<const char> bytes) {
  const auto header = parse_ply_header(bytes);
  if (!header) return header.error();
  const std::span<const char> data = bytes.subspan(header->size);
  static_assert(std::endian::native == std::endian::little);
  switch (header->form) {
    case PlyHeader::Form::text:
      return PlyReader<PlyText>(*header, PlyText(data, header->lines + 1)).read();
    case PlyHeader::Form::little_endian:
      return PlyReader<PlyBinary<false>>(*header, PlyBinary<false>(data)).read();
    case PlyHeader::Form::big_endian:
      return PlyReader<PlyBinary<true>>(*header, PlyBinary<true>(data)).read();
  }
  return Error{"unknown form"};
}

}  // namespace hyades::core
