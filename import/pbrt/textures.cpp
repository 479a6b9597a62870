#include "import/pbrt/textures.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "import/pbrt/read_parameters.h"
#include "import/pbrt/texture_kinds.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {

std::optional<float> plain_number(const YamlPtr& node) {
  if (node == nullptr || node->kind != YamlNode::Kind::scalar || node->quoted) return std::nullopt;
  const auto value = number_of(node->scalar);
  if (!value) return std::nullopt;
  return static_cast<float>(*value);
}

Textures::Textures(Context& context) : context_(context) {
  for (const NamedEntity& t : context.scene.float_textures) float_textures_[t.name] = &t;
  for (const NamedEntity& t : context.scene.spectrum_textures) spectrum_textures_[t.name] = &t;
}

const NamedEntity* Textures::find(bool floats, const std::string& name) const {
  const auto& all = floats ? float_textures_ : spectrum_textures_;
  const auto found = all.find(name);
  return found == all.end() ? nullptr : found->second;
}

std::string Textures::named(bool floats, const std::string& name, const Place& place) {
  const NamedEntity* entity = find(floats, name);
  if (entity == nullptr) {
    context_.report.error(place, std::string("there is no texture '") + name + "' of type " +
                                     (floats ? "float" : "spectrum"));
    return {};
  }
  const auto [known, is_new] = made_.emplace(entity, Made());
  Made& made = known->second;  // stays where it is while others are added
  if (!is_new) {
    if (made.state == Made::State::making) {
      context_.report.error(place, "texture '" + name + "' is made of itself");
    }
    return made.name;
  }
  made.state = Made::State::failed;
  if (depth_ > kLongestChain) {
    context_.report.error(place, fmt::format("texture '{}' is the end of more than {} in a row",
                                             name, kLongestChain));
    return {};
  }
  made.state = Made::State::making;
  ++depth_;
  YamlPtr node = make(floats, *entity);
  --depth_;
  made.state = node == nullptr ? Made::State::failed : Made::State::done;
  if (node == nullptr) return {};
  made.name = context_.texture_names.add(name);
  context_.textures.put(made.name, std::move(node));
  return made.name;
}

YamlPtr Textures::make(bool floats, const NamedEntity& entity) {
  return TextureKinds(*this, context_, entity, floats).make();
}

YamlPtr Textures::color_if(ParameterReader& reader, const char* name) {
  const Parameter* p = reader.find(name);
  if (p == nullptr) return nullptr;
  if (p->type == "texture") {
    const std::string ours = named(false, p->texts[0], p->place);
    return ours.empty() ? nullptr : yaml_text(ours);
  }
  if (p->type == "float" && p->numbers.size() == 1) return yaml_number(p->numbers[0]);
  const auto color = color_of(context_, *p, ColorUse::surface);
  if (color && p->type == "rgb" && *std::max_element(p->numbers.begin(), p->numbers.end()) > 1.0F) {
    context_.report.error(p->place, "parameter '" + p->name + "': found a colour above 1");
    return nullptr;
  }
  return color ? color_node(*color) : nullptr;
}

YamlPtr Textures::color(ParameterReader& reader, const char* name, const Rgb& otherwise) {
  YamlPtr node = color_if(reader, name);
  return node != nullptr ? node : color_node(otherwise);
}

YamlPtr Textures::number_if(ParameterReader& reader, const char* name) {
  if (const Parameter* p = reader.find("texture", name)) {
    const std::string ours = named(true, p->texts[0], p->place);
    return ours.empty() ? nullptr : yaml_text(ours);
  }
  const auto number = reader.number_if(name);
  return number ? yaml_number(*number) : nullptr;
}

YamlPtr Textures::number(ParameterReader& reader, const char* name, float otherwise) {
  YamlPtr node = number_if(reader, name);
  return node != nullptr ? node : yaml_number(otherwise);
}

Textures::Height Textures::height(const std::string& texture, const Place& place) {
  Height out;
  std::string name = texture;
  // A factor of the whole goes into the height: colours of textures are not below 0.
  for (int depth = 0; depth < 32; ++depth) {
    const NamedEntity* entity = find(true, name);
    if (entity == nullptr || entity->type != "scale") break;
    Report unheard;
    ParameterReader reader(entity->parameters, entity->place, unheard);
    const Parameter* inner = reader.find("texture", "tex");
    const Parameter* outer = reader.find("texture", "scale");
    if (inner != nullptr && outer == nullptr) {
      out.factor *= reader.number("scale", 1.0F);
      name = inner->texts[0];
    } else if (outer != nullptr && inner == nullptr) {
      out.factor *= reader.number("tex", 1.0F);
      name = outer->texts[0];
    } else {
      break;
    }
  }
  const std::string ours = named(true, name, place);
  if (!ours.empty()) out.texture = yaml_text(ours);
  return out;
}

}  // namespace hyades::core::pbrt
