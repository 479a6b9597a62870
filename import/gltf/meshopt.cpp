#include "import/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace hyades::core {

namespace {

/// How many times larger than its code a view may be: vertices that are all alike take about a
/// 64th, triangles a 12th.
constexpr size_t kMostGain = 128;

Error bad(const JsonValue& at, const std::string& what) { return Error{at.place() + " " + what}; }

}  // namespace

Result<Bytes> decode_meshopt(const JsonValue& extension, const std::vector<Bytes>& buffers) {
  const int buffer = extension.required_index("buffer", buffers.size());
  const auto offset = static_cast<size_t>(extension.integer("byteOffset", 0, INT32_MAX, 0));
  const auto length = static_cast<size_t>(extension.required_integer("byteLength", 0, INT32_MAX));
  const auto stride = static_cast<size_t>(extension.required_integer("byteStride", 1, 256));
  const auto count = static_cast<size_t>(extension.required_integer("count", 0, INT32_MAX));
  const std::string mode = extension.text("mode");
  const std::string filter = extension.text("filter");
  if (buffer < 0) return Bytes();
  const Bytes& whole = buffers[static_cast<size_t>(buffer)];
  if (offset > whole.size() || length > whole.size() - offset) {
    return bad(extension, fmt::format("has bytes {} to {}, but its buffer has only {}", offset,
                                      offset + length, whole.size()));
  }
  if (count * stride > (length + 64) * kMostGain) {
    return bad(extension, fmt::format("says that {} bytes hold {}", length, count * stride));
  }
  const auto* code = reinterpret_cast<const unsigned char*>(whole.chars()) + offset;
  auto out = std::make_shared<std::vector<std::byte>>(count * stride);
  int failed = 0;
  if (mode == "ATTRIBUTES") {
    if (stride % 4 != 0) return bad(extension, "has a byteStride that is no multiple of 4");
    failed = meshopt_decodeVertexBuffer(out->data(), count, stride, code, length);
  } else if (mode == "TRIANGLES" || mode == "INDICES") {
    if (stride != 2 && stride != 4) return bad(extension, "has a byteStride other than 2 and 4");
    if (mode == "TRIANGLES" && count % 3 != 0) return bad(extension, "has no whole triangles");
    failed = mode == "TRIANGLES"
                 ? meshopt_decodeIndexBuffer(out->data(), count, stride, code, length)
                 : meshopt_decodeIndexSequence(out->data(), count, stride, code, length);
  } else {
    return bad(extension, "has mode '" + mode + "', expected ATTRIBUTES, TRIANGLES or INDICES");
  }
  if (failed != 0) return bad(extension, "holds no valid code");
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out->data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out->data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out->data(), count, stride);
  } else if (!filter.empty() && filter != "NONE") {
    return bad(extension, fmt::format("has filter '{}' with a byteStride of {}", filter, stride));
  }
  return Bytes(out, *out);
}

}  // namespace hyades::core
