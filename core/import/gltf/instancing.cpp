#include "core/import/gltf/instancing.h"

#include <fmt/format.h>

#include "core/import/gltf/accessor.h"
#include "core/import/gltf/animation.h"

namespace hyades::core {

Result<std::vector<Mat4>> instance_places(const GltfModel& model,
                                          const GltfAttributes& attributes) {
  std::vector<GltfPlace> places;
  bool counted = false;
  const auto read = [&](const char* name, size_t width, auto&& set) -> Status {
    const auto at = attributes.find(name);
    if (at == attributes.end()) return {};
    const auto numbers = read_floats(model, at->second, width);
    if (!numbers) return numbers.error();
    const size_t count = numbers->size() / width;
    if (counted && count != places.size()) {
      return model.error(fmt::format("{} has {} instances, but another attribute has {}",
                                     model.accessors[static_cast<size_t>(at->second)].place, count,
                                     places.size()));
    }
    counted = true;
    places.resize(count);
    for (size_t i = 0; i < count; ++i) set(places[i], numbers->data() + width * i);
    return {};
  };
  for (const Status& s : {read("TRANSLATION", 3,
                               [](GltfPlace&p, const float*n) {
                                 p.translation = {n[0], n[1], n[2]};
                               }),
                          read("ROTATION", 4,
                               [](GltfPlace&p, const float*n) {
                                 const Vec4 q(n[0], n[1], n[2], n[3]);
                                 const float length = glm::length(q);
                                 if (length > 0.0F) p.rotation = q / length;
                               }),
                          read("SCALE", 3, [](GltfPlace&p, const float*n) {
                            p.scale = {n[0], n[1], n[2]};
                          })}) {
    if (!s) return s.error();
  }
  std::vector<Mat4> out;
  out.reserve(places.size());
  for (const GltfPlace& place : places) out.push_back(matrix_of(place));
  return out;
}

}  // namespace hyades::core
