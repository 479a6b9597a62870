#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "jobs/generator/mesh_writer.h"

namespace hyades::gallery {

/// A binary glTF file under construction: its JSON, to be written to, and one buffer.
class GlbWriter {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}, {"generator", "jobs/generator"}}}};

  /// Appends an accessor of floats, `width` to an element (1 to 4, or 16: matrices); its number.
  /// Bounds are told, as positions and times of keys must.
  int floats(std::span<const float> numbers, int width);

  /// Appends an accessor of bytes, four to an element; its number. `normalized`: 255 means 1.
  int bytes(std::span<const uint8_t> numbers, bool normalized);

  /// Indices of triangles.
  int indices(const std::vector<std::array<uint32_t, 3>>& triangles);

  int positions(const std::vector<Vec3>& points) {
    return floats({&points[0].x, 3 * points.size()}, 3);
  }

  /// Appends to a list at the top; its number there.
  int add(const char* list, nlohmann::json item);

  /// The whole file.
  std::string file() const;

 private:
  int view(const void* data, size_t size);

  std::string buffer_;
};

}  // namespace hyades::gallery
