#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/job/fields.h"
#include "core/job/source.h"

namespace hyades::core {

/// Which rays see something (RayKind in core/geometry/world.h); lights of places and directions
/// have the four kinds of scattered rays only.
struct VisibilityDesc {
  bool camera = true;
  bool diffuse = true;
  bool glossy = true;
  bool transmission = true;
  bool volume = true;
  bool shadow = true;

  bool all_scattered() const { return diffuse && glossy && transmission && volume; }

  template <class Self, class Visitor>
  static void scattered_fields(Self& self, Visitor& visit) {
    visit.flag("visible_to_diffuse", self.diffuse);
    visit.flag("visible_to_glossy", self.glossy);
    visit.flag("visible_to_transmission", self.transmission);
    visit.flag("visible_to_volume", self.volume);
  }
};

/// Which objects a light lights (light linking), or in whose shadow it leaves others (shadow
/// linking). A name stands for the object and all that is in it.
struct LinkingDesc {
  SourceLocation where;
  std::optional<std::vector<std::string>> include;  ///< nothing: all objects
  std::optional<std::vector<std::string>> exclude;  ///< but for these

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.names_of("include", self.include, NameKind::object);
    visit.names_of("exclude", self.exclude, NameKind::object);
  }
};

/// The keys that all lights have in common.
struct LightLinkDesc {
  std::optional<LinkingDesc> light_linking;
  std::optional<LinkingDesc> shadow_linking;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.map("light_linking", "linking", self.light_linking);
    visit.map("shadow_linking", "linking", self.shadow_linking);
  }
};

}  // namespace hyades::core
