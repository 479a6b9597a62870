#include "core/job/layers.h"

namespace hyades::core {

bool makes_splats(const IntegratorDesc& integrator) {
  return integrator.type == "bdpt" || integrator.type == "mlt";
}

LayerSet needed_layers(const Job& job) {
  LayerSet layers;
  for (const OutputDesc& output : job.outputs) {
    for (const std::string& layer : output.layers) {
      if (layer == "depth") layers.depth = true;
      if (layer == "albedo") layers.albedo = true;
      if (layer == "normal") layers.normal = true;
    }
  }
  layers.splats = makes_splats(job.integrator);
  return layers;
}

}  // namespace hyades::core
