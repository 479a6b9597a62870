#include "import/tinted.h"

namespace hyades::core {

namespace {

YamlPtr named(const std::string& name) { return name.empty() ? nullptr : yaml_text(name); }

}  // namespace

YamlPtr color_node(const Rgb& color) {
  const bool grey = color.x == color.y && color.y == color.z;
  return grey ? yaml_number(color.x) : yaml_vector(color);
}

YamlPtr product(const YamlPtr& input, const YamlPtr& factor) {
  return YamlMap{{"type", yaml_word("scale")}, {"input", input}, {"factor", factor}}.node();
}

YamlPtr tinted(const Rgb& factor, const YamlPtr& texture) {
  if (!texture) return color_node(factor);
  if (factor == Rgb(0.0F)) return color_node(factor);
  return factor == Rgb(1.0F) ? texture : product(texture, color_node(factor));
}

YamlPtr tinted(const Rgb& factor, const std::string& name) { return tinted(factor, named(name)); }

YamlPtr scaled(float factor, const YamlPtr& texture) { return tinted(Rgb(factor), texture); }

YamlPtr scaled(float factor, const std::string& name) { return scaled(factor, named(name)); }

}  // namespace hyades::core
