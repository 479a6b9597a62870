#include "core/job/layers.h"

namespace hyades::core {

LayerSet needed_layers(const Job& job) {
  LayerSet layers;
  for (const OutputDesc& output : job.outputs) {
    for (const std::string& layer : output.layers) {
      if (layer == "depth") layers.depth = true;
      if (layer == "albedo") layers.albedo = true;
      if (layer == "normal") layers.normal = true;
    }
  }
  return layers;
}

}  // namespace hyades::core
