#include "import/gltf/draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <utility>

namespace hyades::core {

namespace {

/// Good meshes take several bits per triangle. The library believes the number of triangles before
/// it has read any, so that more than this many per byte are refused first.
constexpr uint64_t kMostCornersPerByte = 32;

std::optional<uint64_t> varint(const std::byte*& at, const std::byte* end) {
  uint64_t value = 0;
  for (unsigned shift = 0; at < end && shift < 63; shift += 7) {
    const auto byte = static_cast<uint64_t>(*at++);
    value |= (byte & 0x7FU) << shift;
    if ((byte & 0x80U) == 0) return value;
  }
  return std::nullopt;
}

/// The number of triangles that the code says it has: after "DRACO", version, kind, method and
/// flags (Draco bitstream specification 2.2, sections 2 and 4).
std::optional<uint64_t> triangles_said(std::span<const std::byte> code) {
  if (code.size() < 14) return std::nullopt;
  const auto method = static_cast<int>(code[8]);
  const std::byte* at = code.data() + 11;
  const std::byte* end = code.data() + code.size();
  if (method == 1) {
    ++at;  // how connectivity is coded; the number of vertices follows
    if (!varint(at, end)) return std::nullopt;
  }
  return varint(at, end);
}

Result<DracoMesh::Attribute> read_attribute(const draco::Mesh& mesh, int id) {
  const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id));
  if (from == nullptr)
    return Error{fmt::format("names Draco attribute {}, which is not there", id)};
  DracoMesh::Attribute out;
  out.components = static_cast<size_t>(from->num_components());
  if (out.components < 1 || out.components > 4) {
    return Error{fmt::format("has a Draco attribute of {} numbers", out.components)};
  }
  out.values.resize(mesh.num_points() * out.components);
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    float* to = out.values.data() + i.value() * out.components;
    if (!from->ConvertValue(from->mapped_index(i), static_cast<int8_t>(out.components), to)) {
      return Error{"has a Draco attribute that holds no numbers"};
    }
  }
  return out;
}

Result<DracoMesh> decode(const GltfPrimitive& primitive, std::span<const std::byte> code) {
  const auto said = triangles_said(code);
  if (!said || *said > kMostCornersPerByte * code.size()) return Error{"holds no valid Draco code"};
  if ((static_cast<unsigned>(code[10]) & 0x80U) != 0) {
    return Error{"holds Draco metadata, which are not supported"};
  }
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(code.data()), code.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    return Error{std::string("holds no valid Draco code: ") + decoded.status().error_msg()};
  }
  const draco::Mesh& mesh = *decoded.value();
  DracoMesh out;
  out.indices.reserve(size_t{3} * mesh.num_faces());
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(i)) out.indices.push_back(corner.value());
  }
  for (const auto& [name, id] : primitive.draco->attributes) {
    auto attribute = read_attribute(mesh, id);
    if (!attribute) return attribute.error();
    out.attributes[name] = std::move(*attribute);
  }
  return out;
}

}  // namespace

Result<DracoMesh> decode_draco(const GltfModel& model, const GltfPrimitive& primitive) {
  const Bytes& code = model.views[static_cast<size_t>(primitive.draco->view)].bytes;
  try {
    auto out = decode(primitive, code.span());
    if (!out) return model.error(primitive.place + " " + out.error().message);
    return out;
  } catch (const std::bad_alloc&) {
    return model.error(primitive.place + " asks for more memory than there is");
  }
}

}  // namespace hyades::core
