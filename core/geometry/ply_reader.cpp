#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <string>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/mesh_source.h"
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
    for (size_t i = 0, at = 0; i < polygons_.sizes.size(); at += polygons_.sizes[i++]) {
      const std::span<const uint32_t> corners(polygons_.corners);
      triangulate(mesh_->positions, corners.subspan(at, polygons_.sizes[i]), mesh_->triangles);
    }
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
    if constexpr (!Source::kText) {
      if (!e.has_lists()) return read_fixed_vertices(e, *layout);
    }
    for (size_t i = 0; i < n; ++i) {
      PlyRow row{};
      for (size_t k = 0; k < e.properties.size(); ++k) {
        float value = 0.0F;
        const PlyProperty& p = e.properties[k];
        if (p.is_list) {
          if (Status s = skip_list(p); !s) return s;
        } else if (!source_.number(p.type, value)) {
          return source_.truncated().in("row " + std::to_string(i));
        }
        if (layout->slots[k] != kIgnored) row[static_cast<size_t>(layout->slots[k])] = value;
      }
      store(i, row);
    }
    return {};
  }

  void store(size_t i, const PlyRow& row) {
    mesh_->positions[i] = {row[kX], row[kY], row[kZ]};
    if (!mesh_->normals.empty()) mesh_->normals[i] = {row[kNx], row[kNy], row[kNz]};
    if (!mesh_->uvs.empty()) mesh_->uvs[i] = {row[kU], row[kV]};
  }

  /// Rows of one size: read in parallel.
  Status read_fixed_vertices(const PlyElement& e, const PlyLayout& layout) {
    struct Column {
      size_t offset;
      PlyType type;
      PlySlot slot;
    };
    std::vector<Column> columns;
    size_t stride = 0;
    for (size_t k = 0; k < e.properties.size(); ++k) {
      if (layout.slots[k] != kIgnored) {
        columns.push_back({stride, e.properties[k].type, layout.slots[k]});
      }
      stride += size_of(e.properties[k].type);
    }
    if (e.count > source_.left() / stride) return source_.truncated();
    const char* data = source_.at();
    for_chunks(e.count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        PlyRow row{};
        for (const Column& c : columns) {
          row[static_cast<size_t>(c.slot)] =
              load_as<float, Source::kSwap>(c.type, data + i * stride + c.offset);
        }
        store(i, row);
      }
    });
    source_.skip(e.count * stride);
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
    mesh_->triangles.resize(e.count);
    std::atomic<bool> fits{true};
    for_chunks(e.count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const char* row = data + i * stride;
        if (load_as<int64_t, Source::kSwap>(list->count_type, row) != 3) {
          fits = false;
          return;
        }
        for (size_t k = 0; k < 3; ++k) {
          const auto index = load_as<int64_t, Source::kSwap>(list->type, row + first + k * step);
          // Negative ones become too large, which the check of all indices finds.
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
      return source_.error("vertex index " + std::to_string(index) +
                           " is out of range: there are " + std::to_string(vertex_count_) +
                           " vertices");
    }
    return static_cast<uint32_t>(index);
  }

  Status read_polygon(const PlyProperty& p) {
    const auto count = list_length(p);
    if (!count) return count.error();
    if (*count > kMaxCorners) {
      return source_.error("a face has " + std::to_string(*count) + " corners; at most " +
                           std::to_string(kMaxCorners) + " are possible");
    }
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
        return source_.error("vertex index " + std::to_string(index) +
                             " is out of range: there are " + std::to_string(vertex_count_) +
                             " vertices");
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
