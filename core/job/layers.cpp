#include "core/job/layers.h"

#include <cstddef>
#include <set>
#include <string>

#include "core/job/light_groups.h"
#include "core/job/output_names.h"

namespace hyades::core {

bool makes_splats(const IntegratorDesc& integrator) {
  return integrator.type == "bdpt" || integrator.type == "mlt";
}

LayerSet needed_layers(const Job& job) {
  LayerSet layers;
  std::set<std::string> groups;
  for (const OutputDesc& output : job.outputs) {
    if (output.denoise != "false") layers.albedo = layers.normal = true;
    for (const std::string& layer : output.layers) {
      if (layer == "depth") layers.depth = true;
      if (layer == "albedo") layers.albedo = true;
      if (layer == "normal") layers.normal = true;
      if (layer == "position") layers.position = true;
      if (layer == "motion") layers.motion = true;
      if (layer == "object_id" || layer == "crypto_object") layers.ids[0] = true;
      if (layer == "material_id" || layer == "crypto_material") layers.ids[1] = true;
      for (const std::string& name : unfolded(layer)) {
        for (size_t i = 0; i < kLightComponents; ++i) {
          if (name == name_of(static_cast<LightComponent>(i))) layers.components[i] = true;
        }
      }
      if (layer.starts_with(kGroupPrefix)) groups.insert(layer.substr(kGroupPrefix.size()));
      if (layer == "light_groups") {
        for (const std::string& group : light_groups_of(job)) groups.insert(group);
        groups.insert(kRestGroup);
      }
    }
  }
  layers.light_groups.assign(groups.begin(), groups.end());
  layers.splats = makes_splats(job.integrator);
  return layers;
}

}  // namespace hyades::core
