#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "import/gltf/meshopt.h"
#include "import/gltf/read_model.h"

namespace hyades::core {

namespace {

constexpr int64_t kMost = int64_t{1} << 46;

size_t length_of(const JsonValue& value, std::string_view key) {
  return static_cast<size_t>(value.integer(key, 0, kMost, 0));
}

size_t components_of(const JsonValue& accessor) {
  static const std::array<std::pair<const char*, size_t>, 7> kTypes{{{"SCALAR", 1},
                                                                     {"VEC2", 2},
                                                                     {"VEC3", 3},
                                                                     {"VEC4", 4},
                                                                     {"MAT2", 4},
                                                                     {"MAT3", 9},
                                                                     {"MAT4", 16}}};
  const std::string type = accessor.text("type");
  for (const auto& [name, components] : kTypes) {
    if (type == name) return components;
  }
  accessor.member("type").complain("is '" + type +
                                   "', expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
  return 1;
}

GltfComponent component_of(const JsonValue& value) {
  const int64_t type = value.required_integer("componentType", 5120, 5126);
  if (type == 5124) value.member("componentType").complain("is 5124, which is no component type");
  return type == 5124 ? GltfComponent::uint32 : static_cast<GltfComponent>(type);
}

/// Complains where `count` elements from `offset` on do not lie within a view.
void check_range(const JsonValue& at, const GltfView& view, size_t offset, size_t count,
                 size_t element, size_t stride) {
  if (stride != 0 && stride < element) {
    at.complain(
        fmt::format("has elements of {} bytes, but its view has one every {}", element, stride));
    return;
  }
  const size_t step = stride != 0 ? stride : element;
  const size_t size = view.bytes.size();
  const bool fits = count == 0 || (offset <= size && element <= size - offset &&
                                   (count - 1) <= (size - offset - element) / step);
  if (!fits) {
    at.complain(
        fmt::format("has {} elements of {} bytes, which do not lie within the {} bytes of "
                    "its view",
                    count, element, size));
  }
}

GltfSparse read_sparse(const JsonValue& sparse, const GltfAccessor& accessor,
                       const std::vector<GltfView>& views) {
  GltfSparse out;
  out.count = static_cast<size_t>(
      sparse.required_integer("count", 0, static_cast<int64_t>(accessor.count)));
  const JsonValue indices = sparse.member("indices");
  out.index_view = indices.required_index("bufferView", views.size());
  out.index_offset = length_of(indices, "byteOffset");
  out.index_type = component_of(indices);
  const bool whole = out.index_type == GltfComponent::uint8 ||
                     out.index_type == GltfComponent::uint16 ||
                     out.index_type == GltfComponent::uint32;
  if (!whole) indices.complain("has a componentType that is no unsigned integer");
  const JsonValue values = sparse.member("values");
  out.value_view = values.required_index("bufferView", views.size());
  out.value_offset = length_of(values, "byteOffset");
  if (out.index_view < 0 || out.value_view < 0) return out;
  check_range(indices, views[static_cast<size_t>(out.index_view)], out.index_offset, out.count,
              size_of(out.index_type), 0);
  check_range(values, views[static_cast<size_t>(out.value_view)], out.value_offset, out.count,
              accessor.element_size(), 0);
  return out;
}

}  // namespace

size_t size_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::int8:
    case GltfComponent::uint8:
      return 1;
    case GltfComponent::int16:
    case GltfComponent::uint16:
      return 2;
    case GltfComponent::uint32:
    case GltfComponent::float32:
      return 4;
  }
  return 4;
}

Result<std::vector<GltfView>> read_views(const JsonValue& root, const std::vector<Bytes>& buffers) {
  std::vector<GltfView> views;
  for (const JsonValue& view : root.list("bufferViews")) {
    GltfView out;
    out.stride = static_cast<size_t>(view.integer("byteStride", 0, 252, 0));
    const int buffer = view.required_index("buffer", buffers.size());
    const size_t offset = length_of(view, "byteOffset");
    const auto length = static_cast<size_t>(view.required_integer("byteLength", 0, kMost));
    const JsonValue extensions = view.member("extensions");
    JsonValue packed = extensions.member("EXT_meshopt_compression");
    if (!packed.exists()) packed = extensions.member("KHR_meshopt_compression");
    if (packed.exists()) {
      auto unpacked = decode_meshopt(packed, buffers);
      if (!unpacked) return unpacked.error();
      out.bytes = *unpacked;
      out.stride = length_of(packed, "byteStride");
    } else if (buffer >= 0) {
      const Bytes& bytes = buffers[static_cast<size_t>(buffer)];
      if (offset > bytes.size() || length > bytes.size() - offset) {
        view.complain(fmt::format("has bytes {} to {}, but its buffer has only {}", offset,
                                  offset + length, bytes.size()));
      } else {
        out.bytes = Bytes(std::make_shared<Bytes>(bytes), bytes.span().subspan(offset, length));
      }
    }
    views.push_back(std::move(out));
  }
  return views;
}

Result<std::vector<GltfAccessor>> read_accessors(const JsonValue& root,
                                                 const std::vector<GltfView>& views) {
  std::vector<GltfAccessor> accessors;
  for (const JsonValue& value : root.list("accessors")) {
    GltfAccessor out;
    out.place = value.place();
    out.view = value.index("bufferView", views.size());
    out.offset = length_of(value, "byteOffset");
    out.component = component_of(value);
    out.normalized = value.flag("normalized", false);
    out.components = components_of(value);
    out.count = static_cast<size_t>(value.required_integer("count", 0, INT32_MAX));
    if (out.view >= 0) {
      const GltfView& view = views[static_cast<size_t>(out.view)];
      check_range(value, view, out.offset, out.count, out.element_size(), view.stride);
    }
    const JsonValue sparse = value.member("sparse");
    if (sparse.exists()) out.sparse = read_sparse(sparse, out, views);
    if (out.components == 3 && out.component == GltfComponent::float32) {
      std::array<Vec3, 2> extent{};
      const bool has_min = value.numbers("min", std::span(&extent[0].x, 3));
      if (has_min && value.numbers("max", std::span(&extent[1].x, 3))) out.extent = extent;
    }
    accessors.push_back(std::move(out));
  }
  return accessors;
}

}  // namespace hyades::core
