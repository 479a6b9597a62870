#include "core/scene/flatten.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>

#include "core/job/frame_files.h"
#include "core/job/references.h"
#include "core/scene/appearance.h"
#include "core/scene/displacement.h"
#include "core/scene/shape_makers.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

class Flattener {
 public:
  Flattener(const Job& job, int32_t frame, SceneCache& cache, Displacements displacements)
      : job_(job),
        frame_(frame),
        cache_(cache),
        looks_(job, job.time_of(frame), cache),
        displacements_(displacements),
        extras_(mesh_extras_of(job)) {
    for (const GroupDesc& group : job.groups) groups_.emplace(group.name, &group);
    for (const MaterialDesc& material : job.materials) {
      const auto* principled = std::get_if<PrincipledDesc>(&material.kind);
      if (principled != nullptr && principled->emits()) shining_.emplace(material.name, principled);
      if (std::holds_alternative<HairDesc>(material.kind)) hair_.insert(material.name);
    }
    add_made_of_hair();
  }

  Status add_all(const std::vector<ObjectDesc>& objects, const std::string& prefix,
                 const std::string& material) {
    if (chain_.size() > kMaxDepth) return Error{"group '" + prefix + "' contains itself"};
    for (const ObjectDesc& object : objects) {
      chain_.push_back(&object);
      if (!object.overrides.empty()) overridden_[&object].clear();
      auto added = add(object, prefix + object.name, material);
      chain_.pop_back();
      if (!added) return added;
      for (const auto& [from, to] : object.overrides) {
        if (overridden_[&object].contains(from)) continue;
        return at(object, Error{"object '" + prefix + object.name + "' overrides the material '" +
                                from + "', which nothing in it has"});
      }
    }
    return {};
  }

  std::vector<FlatObject> take() { return std::move(flat_); }

 private:
  static constexpr size_t kMaxDepth = 64;

  Status add(const ObjectDesc& object, const std::string& name, const std::string& inherited) {
    const std::string& material = object.material.empty() ? inherited : object.material;
    if (object.shape == "group") return add_all(object.children, name + "/", material);
    if (object.shape == "instance") {
      const auto group = groups_.find(object.instance_of);
      if (group == groups_.end()) {
        return at(object, Error{"there is no group '" + object.instance_of + "'"});
      }
      if (object.places.empty()) {
        return add_all(group->second->objects, name + "/", material);
      }
      return add_copies(object, *group->second, name, material);
    }
    if (flat_.size() >= kMaxPlacements) {
      return Error{"groups and instances make more than " + std::to_string(kMaxPlacements) +
                   " objects"};
    }
    std::vector<Mat4> to_world =
        shutter_matrices(job_, frame_, [&](const JobTime& time) { return chain_matrix(time); });
    const DisplacementSetting displacement{looks_, to_world.front(), extras_};
    const bool displaces = displacements_ == Displacements::made;
    FlatObject flat;
    ShapeSetting setting{cache_, looks_.time(), extras_, displaces ? &displacement : nullptr};
    setting.shutter = displaces ? job_.frames.shutter : 0.0F;
    setting.notice = &flat.notice;
    auto shape = make_shape(object, setting);
    if (!shape) return at(object, shape.error().in("object '" + name + "'"));
    const std::string look = after_overrides(material);
    flat.desc = &object;
    flat.name = name;
    flat.material = look;
    flat.body = flat_.size();
    flat.emit = emission_of(object, look);
    if (hair_.contains(look) && object.shape != "curves") {
      return at(object, Error{"object '" + name + "' is of the material '" + look +
                              "', which is for strands of hair: expected curves"});
    }
    if (flat.emit && object.shape == "curves") {
      return at(object, Error{"object '" + name + "' is of the material '" + look +
                              "', which gives off light: curves cannot"});
    }
    flat.placement.shape = *shape;
    flat.placement.instancer = instancer_;
    flat.placement.seen_by = seen_by();
    flat.holdout = is_holdout();
    flat.placement.changes_between_frames = chain_is_animated() || size_changes(object) ||
                                            displacement_changes(job_, object) ||
                                            is_file_sequence(object.mesh);
    flat.placement.to_world = std::move(to_world);
    flat_.push_back(std::move(flat));
    if (object.shape == "cylinder" && object.caps) add_caps(object, name, look);
    return {};
  }

  /// Copies of a group at the places of a file.
  Status add_copies(const ObjectDesc& object, const GroupDesc& group, const std::string& name,
                    const std::string& material) {
    const auto refuse = [&](const Error& error) {
      return at(object, error.in("object '" + name + "'"));
    };
    if (instancer_ != nullptr) {
      return refuse({"its copies would be copied in their turn by '" + instancer_->name +
                     "'; expected one file of places at most around an object"});
    }
    const auto places = cache_.places(object.places);
    if (!places) return refuse(places.error());
    auto instancer = std::make_shared<PointInstancer>();
    instancer->name = object.places;
    instancer->places = *places;
    instancer->to_world =
        shutter_matrices(job_, frame_, [&](const JobTime& time) { return chain_matrix(time); });
    instancer_ = std::move(instancer);
    inside_ = chain_.size();
    const size_t first = flat_.size();
    const Status added = add_all(group.objects, name + "/", material);
    instancer_ = nullptr;
    inside_ = 0;
    if (!added) return added;
    for (size_t i = first; i < flat_.size(); ++i) {
      const FlatObject& flat = flat_[i];
      if (flat.emit)
        return refuse({"'" + flat.name +
                       "' gives off light, which copies by a file of "
                       "places cannot; expected lamps as objects of their own"});
      if (varies(flat.desc->interior)) {
        return refuse({"'" + flat.name + "' is filled with '" + flat.desc->interior +
                       "', which varies within a body; expected a medium that is the same "
                       "everywhere for copies by a file of places"});
      }
    }
    return {};
  }

  bool varies(const std::string& medium) const {
    return std::any_of(job_.media.begin(), job_.media.end(),
                       [&](const MediumDesc& desc) { return desc.name == medium && desc.varying; });
  }

  /// Materials that are mixed or layered of hair are hair.
  void add_made_of_hair() {
    for (size_t known = 0; known != hair_.size();) {
      known = hair_.size();
      for (const MaterialDesc& material : job_.materials) {
        for (const std::string& part : names_in(material, NameKind::material)) {
          if (hair_.contains(part)) hair_.insert(material.name);
        }
      }
    }
  }

  /// The object's own, else that of its material.
  std::optional<EmitDesc> emission_of(const ObjectDesc& object, const std::string& material) const {
    if (object.emit) return object.emit;
    const auto shining = shining_.find(material);
    if (shining == shining_.end()) return std::nullopt;
    EmitDesc emit;
    emit.color = shining->second->emission_color;
    emit.amount = shining->second->emission_strength;
    emit.two_sided = shining->second->thin_walled;
    return emit;
  }

  /// The material that an object gets where its own is `material`: the outermost override counts.
  std::string after_overrides(const std::string& material) {
    const std::string* look = nullptr;
    for (const ObjectDesc* object : chain_) {
      for (const auto& [from, to] : object->overrides) {
        if (from != material) continue;
        overridden_[object].insert(from);
        if (look == nullptr) look = &to;
      }
    }
    return look != nullptr ? *look : material;
  }

  static Error at(const ObjectDesc& object, const Error& error) {
    return {Diagnostic{object.where, error.message}.to_string()};
  }

  /// The two discs that close a cylinder.
  void add_caps(const ObjectDesc& object, const std::string& name, const std::string& material) {
    const size_t body = flat_.size() - 1;
    for (const bool top : {false, true}) {
      FlatObject cap;
      cap.desc = &object;
      cap.name = name + (top ? "/top" : "/bottom");
      cap.material = material;
      cap.body = body;
      cap.emit = emission_of(object, material);
      cap.placement.shape.kind = Shape::Kind::disk;
      cap.placement.shape.radius = object.radius.at(looks_.time());
      cap.placement.seen_by = seen_by();
      cap.holdout = is_holdout();
      cap.placement.instancer = instancer_;
      cap.placement.changes_between_frames = chain_is_animated() || size_changes(object);
      Mat4 place(1.0F);
      if (top) {
        place[3].y = object.height.at(looks_.time());
      } else {  // turned over around x: the normal points down, away from the tube
        place[1].y = -1.0F;
        place[2].z = -1.0F;
      }
      cap.placement.to_world = shutter_matrices(
          job_, frame_, [&](const JobTime& time) { return chain_matrix(time) * place; });
      flat_.push_back(std::move(cap));
    }
  }

  /// The rays that see the object and every group around it.
  RayKind seen_by() const {
    RayKind kinds = RayKind::all;
    for (const ObjectDesc* object : chain_) kinds = kinds & kinds_of(object->visible);
    return kinds;
  }

  bool is_holdout() const {
    return std::any_of(chain_.begin(), chain_.end(),
                       [](const ObjectDesc* object) { return object->holdout; });
  }

  /// Whether the object or a group around it is placed by keys or expressions.
  bool chain_is_animated() const {
    return std::any_of(chain_.begin(), chain_.end(), [](const ObjectDesc* object) {
      return !object->at.is_constant() || is_animated(object->transform);
    });
  }

  /// Object to world, through all enclosing groups, scaled to metres; within an instancer to the
  /// space of its copies.
  Mat4 chain_matrix(const JobTime& time) const {
    Mat4 m(1.0F);
    for (int i = 0; i < 3 && instancer_ == nullptr; ++i) m[i][i] = job_.units;
    for (size_t i = instancer_ == nullptr ? 0 : inside_; i < chain_.size(); ++i)
      m = m * transform_at(chain_[i]->transform, chain_[i]->at, time);
    return m;
  }

  const Job& job_;
  int32_t frame_;
  SceneCache& cache_;
  Appearance looks_;  ///< when the shutter opens
  Displacements displacements_;
  MeshExtras extras_;
  std::map<std::string_view, const GroupDesc*> groups_;
  std::map<std::string_view, const PrincipledDesc*> shining_;  ///< materials that do
  std::set<std::string> hair_;                                 ///< materials for strands
  /// Of objects with overrides in the chain: the materials for which they were asked.
  std::unordered_map<const ObjectDesc*, std::set<std::string>> overridden_;
  std::vector<const ObjectDesc*> chain_;  ///< from the outermost group to the object in hand
  std::vector<FlatObject> flat_;
  std::shared_ptr<const PointInstancer> instancer_;  ///< whose copies hold what is added
  size_t inside_ = 0;                                ///< of chain_, where its group begins
};

}  // namespace

RayKind kinds_of(const VisibilityDesc& visible) {
  RayKind kinds = RayKind::none;
  const auto add = [&](bool seen, RayKind kind) {
    if (seen) kinds = kinds | kind;
  };
  add(visible.camera, RayKind::camera);
  add(visible.diffuse, RayKind::diffuse);
  add(visible.glossy, RayKind::glossy);
  add(visible.transmission, RayKind::transmission);
  add(visible.volume, RayKind::volume);
  add(visible.shadow, RayKind::shadow);
  return kinds;
}

Error at_object(const FlatObject& object, const Error& error) {
  const Error named = error.in("object '" + object.name + "'");
  return {Diagnostic{object.desc->where, named.message}.to_string()};
}

Result<std::vector<FlatObject>> flatten_objects(const Job& job, int32_t frame, SceneCache& cache,
                                                Displacements displacements) {
  Flattener flattener(job, frame, cache, displacements);
  if (auto done = flattener.add_all(job.objects, "", ""); !done) return done.error();
  return flattener.take();
}

}  // namespace hyades::core
