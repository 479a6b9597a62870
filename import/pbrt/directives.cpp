#include "import/pbrt/directives.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "import/mass_copies.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {
namespace {

constexpr size_t kDeepestAttributes = 4096;
constexpr size_t kMostAttributes = 256;  ///< of shapes, say, that hold at a time: each has them all
constexpr size_t kMostShapes = size_t{1} << 22;     ///< objects of a job
constexpr size_t kMostInstances = size_t{1} << 17;  ///< instances that are objects of a job

}  // namespace

const std::unordered_map<std::string_view, Directives::Handler>& Directives::handlers() {
  using D = Directives;
  static const std::unordered_map<std::string_view, Handler> all = {
      {"Accelerator", &D::accelerator},
      {"ActiveTransform", &D::active_transform},
      {"AreaLightSource", &D::area_light_source},
      {"Attribute", &D::attribute},
      {"AttributeBegin", &D::attribute_begin},
      {"AttributeEnd", &D::attribute_end},
      {"Camera", &D::camera},
      {"ColorSpace", &D::color_space},
      {"ConcatTransform", &D::concat_transform},
      {"CoordSysTransform", &D::coord_sys_transform},
      {"CoordinateSystem", &D::coordinate_system},
      {"Film", &D::film},
      {"Identity", &D::identity},
      {"Import", &D::import},
      {"Include", &D::include},
      {"Integrator", &D::integrator},
      {"LightSource", &D::light_source},
      {"LookAt", &D::look_at_directive},
      {"MakeNamedMaterial", &D::make_named_material},
      {"MakeNamedMedium", &D::make_named_medium},
      {"Material", &D::material},
      {"MediumInterface", &D::medium_interface},
      {"NamedMaterial", &D::named_material},
      {"ObjectBegin", &D::object_begin},
      {"ObjectEnd", &D::object_end},
      {"ObjectInstance", &D::object_instance},
      {"Option", &D::option},
      {"PixelFilter", &D::pixel_filter},
      {"ReverseOrientation", &D::reverse_orientation},
      {"Rotate", &D::rotate},
      {"Sampler", &D::sampler},
      {"Scale", &D::scale},
      {"Shape", &D::shape},
      {"Texture", &D::texture},
      {"Transform", &D::transform},
      {"TransformBegin", &D::attribute_begin},
      {"TransformEnd", &D::attribute_end},
      {"TransformTimes", &D::transform_times},
      {"Translate", &D::translate},
      {"WorldBegin", &D::world_begin},
  };
  return all;
}

Directives::Directives(ParsedScene& scene, Includer& includer)
    : scene_(scene), includer_(includer) {
  scene_.film.type = "rgb";
  scene_.filter.type = "gaussian";
  scene_.sampler.type = "zsobol";
  scene_.integrator.type = "volpath";
  scene_.camera.type = "perspective";
  Entity matt;
  matt.type = "diffuse";
  scene_.materials.push_back(std::move(matt));
}

Status Directives::read(Tokenizer& tokens) {
  Tokenizer* outer = std::exchange(tokens_, &tokens);
  for (;;) {
    const Token token = tokens.next();
    if (token.kind == Token::Kind::end) break;
    place_ = tokens.place(token);
    const auto handler =
        token.kind == Token::Kind::word ? handlers().find(token.text) : handlers().end();
    if (handler == handlers().end()) {
      std::vector<std::string> names;
      for (const auto& entry : handlers()) names.emplace_back(entry.first);
      std::sort(names.begin(), names.end());
      return unexpected(token, "a directive" + did_you_mean(token.text, names));
    }
    if (Status s = (this->*handler->second)(); !s) return s;
  }
  tokens_ = outer;
  return {};
}

Status Directives::finish() const {
  if (!in_world_) return Error{"the scene has no WorldBegin"};
  if (!pushed_.empty()) {
    const Pushed& last = pushed_.back();
    return last.place.error(last.kind == 'o' ? "ObjectBegin has no ObjectEnd"
                                             : "AttributeBegin has no AttributeEnd");
  }
  return {};
}

Status Directives::unexpected(const Token& token, const std::string& expected) const {
  const Place place = tokens_->place(token);
  if (token.kind == Token::Kind::broken) return place.error(std::string(token.text));
  if (token.kind == Token::Kind::end) {
    return place.error("found the end of the file, expected " + expected);
  }
  const std::string found(token.text.substr(0, 60));
  return place.error("found '" + found + "', expected " + expected);
}

Status Directives::take_text(std::string& out, const std::string& what) {
  const Token token = tokens_->next();
  if (token.kind != Token::Kind::text) return unexpected(token, what + " in quotes");
  out = token.text;
  return {};
}

Status Directives::take_numbers(double* out, size_t count) {
  const bool bracketed = tokens_->peek().kind == Token::Kind::open;
  if (bracketed) tokens_->next();
  for (size_t i = 0; i < count; ++i) {
    const Token token = tokens_->next();
    const auto value = token.kind == Token::Kind::word ? number_of(token.text) : std::nullopt;
    if (!value) {
      return unexpected(token, "number " + std::to_string(i + 1) + " of " + std::to_string(count));
    }
    out[i] = *value;
  }
  if (bracketed) {
    const Token token = tokens_->next();
    if (token.kind != Token::Kind::close) return unexpected(token, "]");
  }
  return {};
}

Status Directives::take_entity(Entity& out, const std::string& what) {
  out.place = place_;
  out.space = state_.space;
  if (Status s = take_text(out.type, what); !s) return s;
  auto parameters = read_parameters(*tokens_, state_.space, false);
  if (!parameters) return parameters.error();
  out.parameters = std::move(*parameters);
  return {};
}

Status Directives::only_before_world() const {
  if (!in_world_) return {};
  return error("this directive is only allowed before WorldBegin");
}

Status Directives::only_in_world() const {
  if (in_world_) return {};
  return error("this directive is only allowed after WorldBegin");
}

Status Directives::render_entity(Entity& out, const std::string& what) {
  if (Status s = only_before_world(); !s) return s;
  Entity made;
  if (Status s = take_entity(made, what); !s) return s;
  out = std::move(made);
  return {};
}

Status Directives::film() { return render_entity(scene_.film, "a kind of film"); }
Status Directives::pixel_filter() { return render_entity(scene_.filter, "a kind of filter"); }
Status Directives::sampler() { return render_entity(scene_.sampler, "a kind of sampler"); }
Status Directives::integrator() { return render_entity(scene_.integrator, "an integrator"); }

Status Directives::accelerator() {
  Entity unused;  // how rays find surfaces changes no picture
  return render_entity(unused, "a kind of accelerator");
}

Status Directives::camera() {
  if (Status s = only_before_world(); !s) return s;
  PlacedEntity made;
  if (Status s = take_entity(made, "a kind of camera"); !s) return s;
  for (size_t i = 0; i < 2; ++i) made.to_world.at[i] = glm::inverse(state_.to_world.at[i]);
  coordinate_systems_["camera"] = made.to_world;
  scene_.camera = std::move(made);
  scene_.camera_medium = state_.outside;
  return {};
}

Status Directives::world_begin() {
  if (Status s = only_before_world(); !s) return s;
  in_world_ = true;
  state_.to_world = {};
  state_.active = {true, true};
  coordinate_systems_["world"] = {};
  return {};
}

Status Directives::push(char kind) {
  if (Status s = only_in_world(); !s) return s;
  if (pushed_.size() >= kDeepestAttributes) {
    return error("attributes are nested deeper than " + std::to_string(kDeepestAttributes) +
                 " levels");
  }
  pushed_.push_back({state_, kind, place_});
  return {};
}

Status Directives::pop(char kind, const std::string& what) {
  if (Status s = only_in_world(); !s) return s;
  if (pushed_.empty()) return error(what + " ends nothing that was begun");
  if (pushed_.back().kind != kind) {
    return error(what + " comes before the end of what began at " + pushed_.back().place.text());
  }
  state_ = std::move(pushed_.back().state);
  pushed_.pop_back();
  return {};
}

Status Directives::attribute_begin() { return push('a'); }
Status Directives::attribute_end() { return pop('a', "AttributeEnd"); }

Status Directives::attribute() {
  static const std::vector<std::string> names = {"shape", "light", "material", "medium", "texture"};
  std::string target;
  if (Status s = take_text(target, "what it is for"); !s) return s;
  const auto which = std::find(names.begin(), names.end(), target);
  if (which == names.end()) {
    return error("'" + target + "' has no attributes, expected " + join_names(names));
  }
  auto own = read_parameters(*tokens_, state_.space, true);
  if (!own) return own.error();
  const size_t index = static_cast<size_t>(which - names.begin());
  auto kept = std::make_shared<Parameters>();
  for (const ParameterPtr& p :
       state_.with_attributes(std::move(*own), static_cast<Target>(index))) {
    // Nobody finds one behind another of the same name and type.
    const bool hidden = std::any_of(kept->begin(), kept->end(), [&](const ParameterPtr& other) {
      return other->name == p->name && other->type == p->type;
    });
    if (!hidden) kept->push_back(p);
    if (kept->size() > kMostAttributes) {
      return error("'" + target + "' has more than " + std::to_string(kMostAttributes) +
                   " attributes here");
    }
  }
  state_.attributes[index] = std::move(kept);
  return {};
}

Status Directives::color_space() {
  std::string name;
  if (Status s = take_text(name, "a colour space"); !s) return s;
  const RgbSpace* space = find_rgb_space(name);
  if (space == nullptr) {
    return error("'" + name + "' is no colour space, expected srgb, dci-p3, rec2020 or aces2065-1");
  }
  state_.space = space;
  return {};
}

Status Directives::option() {
  Token name = tokens_->next();
  const Place place = place_;
  std::string key(name.text);
  if (name.kind == Token::Kind::text) {
    // As a parameter: "bool disablepixeljitter" true
    const size_t blank = key.find_last_of(" \t");
    if (blank != std::string::npos) key = key.substr(blank + 1);
  } else if (name.kind != Token::Kind::word) {
    return unexpected(name, "the name of an option");
  }
  const bool bracketed = tokens_->peek().kind == Token::Kind::open;
  if (bracketed) tokens_->next();
  const Token value = tokens_->next();
  if (value.kind != Token::Kind::word && value.kind != Token::Kind::text) {
    return unexpected(value, "the option's value");
  }
  if (bracketed && tokens_->peek().kind == Token::Kind::close) tokens_->next();
  scene_.notes.push_back(place.error("option '" + key + "' is left out").message);
  return {};
}

Status Directives::include() {
  std::string reference;
  const Place place = place_;
  if (Status s = take_text(reference, "a file"); !s) return s;
  return includer_.include(reference, place);
}

Status Directives::import() {
  if (Status s = only_in_world(); !s) return s;
  std::string reference;
  const Place place = place_;
  if (Status s = take_text(reference, "a file"); !s) return s;
  const GraphicsState before = state_;
  const size_t depth = pushed_.size();
  if (Status s = includer_.include(reference, place); !s) return s;
  if (pushed_.size() != depth) {
    return place.error("the imported file does not end all that it begins");
  }
  state_ = before;
  return {};
}

Status Directives::material() {
  if (Status s = only_in_world(); !s) return s;
  Entity made;
  if (Status s = take_entity(made, "a kind of material"); !s) return s;
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::material);
  state_.material = scene_.materials.size();
  state_.material_name.clear();
  scene_.materials.push_back(std::move(made));
  return {};
}

Status Directives::make_named_material() {
  if (Status s = only_in_world(); !s) return s;
  NamedEntity made;
  if (Status s = take_entity(made, "a name"); !s) return s;
  made.name = std::exchange(made.type, {});
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::material);
  const auto [known, is_new] = materials_.emplace(made.name, place_);
  if (!is_new) {
    return error("material '" + made.name + "' is already defined at " + known->second.text());
  }
  scene_.named_materials.push_back(std::move(made));
  return {};
}

Status Directives::named_material() {
  if (Status s = only_in_world(); !s) return s;
  return take_text(state_.material_name, "a name");
}

Status Directives::make_named_medium() {
  NamedEntity made;
  if (Status s = take_entity(made, "a name"); !s) return s;
  made.name = std::exchange(made.type, {});
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::medium);
  made.to_world = state_.to_world;
  const auto [known, is_new] = media_.emplace(made.name, place_);
  if (!is_new) {
    return error("medium '" + made.name + "' is already defined at " + known->second.text());
  }
  scene_.media.push_back(std::move(made));
  return {};
}

Status Directives::medium_interface() {
  if (Status s = take_text(state_.inside, "a medium"); !s) return s;
  state_.outside = state_.inside;
  if (tokens_->peek().kind != Token::Kind::text) return {};
  return take_text(state_.outside, "a medium");
}

Status Directives::texture() {
  if (Status s = only_in_world(); !s) return s;
  NamedEntity made;
  std::string name;
  std::string values;
  if (Status s = take_text(name, "a name"); !s) return s;
  if (Status s = take_text(values, "float or spectrum"); !s) return s;
  if (Status s = take_entity(made, "a kind of texture"); !s) return s;
  if (values != "float" && values != "spectrum") {
    return error("textures are of type float or spectrum, not '" + values + "'");
  }
  const bool floats = values == "float";
  made.name = name;
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::texture);
  made.to_world = state_.to_world;
  const auto [known, is_new] =
      (floats ? float_textures_ : spectrum_textures_).emplace(name, place_);
  if (!is_new) {
    return error("texture '" + name + "' is already defined at " + known->second.text());
  }
  (floats ? scene_.float_textures : scene_.spectrum_textures).push_back(std::move(made));
  return {};
}

Status Directives::light_source() {
  if (Status s = only_in_world(); !s) return s;
  LightEntity made;
  if (Status s = take_entity(made, "a kind of light"); !s) return s;
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::light);
  made.to_world = state_.to_world;
  made.outside = state_.outside;
  scene_.lights.push_back(std::move(made));
  return {};
}

Status Directives::area_light_source() {
  if (Status s = only_in_world(); !s) return s;
  Entity made;
  if (Status s = take_entity(made, "a kind of area light"); !s) return s;
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::light);
  state_.area_light = static_cast<int>(scene_.area_lights.size());
  scene_.area_lights.push_back(std::move(made));
  return {};
}

Status Directives::reverse_orientation() {
  if (Status s = only_in_world(); !s) return s;
  state_.reversed = !state_.reversed;
  return {};
}

Status Directives::shape() {
  if (Status s = only_in_world(); !s) return s;
  ShapeEntity made;
  if (Status s = take_entity(made, "a kind of shape"); !s) return s;
  made.parameters = state_.with_attributes(std::move(made.parameters), Target::shape);
  made.to_world = state_.to_world;
  made.reversed = state_.reversed;
  made.material = state_.material;
  made.material_name = state_.material_name;
  made.area_light = state_.area_light;
  made.inside = state_.inside;
  made.outside = state_.outside;
  auto& shapes = object_ < 0 ? scene_.shapes : scene_.objects[static_cast<size_t>(object_)].shapes;
  if (shapes.size() >= kMostShapes) {
    return error("the scene has more than " + format_count(kMostShapes) + " shapes");
  }
  shapes.push_back(std::move(made));
  return {};
}

Status Directives::object_begin() {
  std::string name;
  if (Status s = take_text(name, "a name"); !s) return s;
  if (object_ >= 0) return error("ObjectBegin within an object, expected ObjectEnd before it");
  if (Status s = push('o'); !s) return s;
  if (!objects_.emplace(name, scene_.objects.size()).second) {
    return error("object '" + name + "' is already defined");
  }
  object_ = static_cast<int>(scene_.objects.size());
  ObjectDefinition& object = scene_.objects.emplace_back();
  object.name = name;
  object.place = place_;
  return {};
}

Status Directives::object_end() {
  if (object_ < 0) return error("ObjectEnd without ObjectBegin");
  if (Status s = pop('o', "ObjectEnd"); !s) return s;
  object_ = -1;
  return {};
}

Status Directives::object_instance() {
  if (Status s = only_in_world(); !s) return s;
  std::string name;
  if (Status s = take_text(name, "a name"); !s) return s;
  if (object_ >= 0) return error("ObjectInstance within an object, expected ObjectEnd before it");
  const auto found = objects_.find(name);
  if (found == objects_.end()) return error("there is no object '" + name + "'");
  ObjectDefinition& object = scene_.objects[found->second];
  const bool still = !state_.to_world.moves();
  if (still && ++object.still >= kFewestCopies) return one_of_many(object);
  if (scene_.instances.size() >= kMostInstances) {
    return error("the scene has more than " + format_count(kMostInstances) +
                 " instances that move, or are of objects with few of them");
  }
  scene_.instances.push_back({found->second, place_, state_.to_world});
  return {};
}

Status Directives::one_of_many(ObjectDefinition& object) {
  if (++copies_ > kMostCopies) {
    return error("the scene has more than " + format_count(kMostCopies) + " instances");
  }
  const PlaceMatrix place{Mat4(state_.to_world.at[0])};
  for (int c = 0; c < 4; ++c) {
    const bool finite =
        std::isfinite(place[c].x) && std::isfinite(place[c].y) && std::isfinite(place[c].z);
    if (!finite) return error("the instance is too far away or too large");
  }
  object.copies.push_back(place);
  return {};
}

}  // namespace hyades::core::pbrt
