#include "core/film/layout.h"

#include "core/film/fixed128.h"
#include "core/film/splats.h"

namespace hyades::core {

FilmLayout make_film_layout(const LayerSet& layers) {
  FilmLayout layout;
  layout.layers = layers;
  const auto append = [&layout](const char* layer, std::initializer_list<const char*> names,
                                MergeRule rule) {
    const int first = static_cast<int>(layout.channels.size());
    for (const char* name : names) layout.channels.push_back({std::string(layer) + name, rule});
    return first;
  };

  append("", {"R", "G", "B", "A"}, MergeRule::sum);
  if (layers.depth) layout.depth = append("depth.", {"Z"}, MergeRule::min);
  if (layers.albedo) layout.albedo = append("albedo.", {"R", "G", "B"}, MergeRule::sum);
  if (layers.normal) layout.normal = append("normal.", {"X", "Y", "Z"}, MergeRule::sum);
  layout.deposited = static_cast<int>(layout.channels.size());
  layout.moment2 = append("moment2.", {"R", "G", "B"}, MergeRule::sum);
  layout.samples = append("samples.", {"N"}, MergeRule::sum);
  return layout;
}

uint64_t film_memory(const FilmLayout& layout, const PixelRect& window) {
  return film_memory(layout, window, window);
}

uint64_t film_memory(const FilmLayout& layout, const PixelRect& window, const PixelRect& region) {
  const uint64_t sums =
      static_cast<uint64_t>(window.area()) * layout.channels.size() * sizeof(Fixed128);
  if (!layout.layers.splats) return sums;
  return sums + static_cast<uint64_t>(region.area()) * sizeof(SplatLayer::Sums);
}

}  // namespace hyades::core
