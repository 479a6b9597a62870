#include "cli/mesh_parts.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "core/geometry/read_mesh.h"
#include "core/job/parse.h"

namespace hyades::cli {

namespace {

using Mtl = std::map<std::string, MtlMaterial>;

/// The materials of one file, as mtllib names it; nothing, and a word on it, where it is not there.
core::Result<Mtl> read_library(const std::string& library, const std::string& mesh,
                               core::AssetResolver& assets) {
  const auto bytes = assets.open(library, mesh);
  if (!bytes) {
    std::fprintf(stderr, "%s: %s; its materials are clay\n", mesh.c_str(),
                 bytes.error().message.c_str());
    return Mtl{};
  }
  auto materials = parse_mtl({bytes->chars(), bytes->size()});
  if (!materials) return materials.error().in(core::resolve_reference(library, mesh));
  return materials;
}

/// The media of a file: whether each has an index of refraction.
core::Result<std::map<std::string, bool>> read_media(const std::string& file,
                                                     core::AssetResolver& assets) {
  if (const auto bytes = assets.open(file); !bytes) return bytes.error();
  core::Diagnostics diagnostics;
  const std::string text = "hyades: 1\nmedia: {file: " + nlohmann::json(file).dump() + "}\n";
  const core::Job job = core::parse_job(text, "", assets, diagnostics);
  if (!diagnostics.empty()) return diagnostics.to_error();
  std::map<std::string, bool> media;
  for (const core::MediumDesc& medium : job.media) media[medium.name] = medium.index.has_value();
  if (media.empty()) return core::Error{file + ": there is no medium in it"};
  return media;
}

template <class Names>
std::string listed(const Names& names) {
  constexpr size_t kMost = 12;
  std::vector<std::string> some;
  for (const auto& name : names) {
    if (some.size() < kMost) some.push_back(name);
  }
  if (names.size() > kMost)
    return "'" + some.front() + "' and " + std::to_string(names.size() - 1) + " more";
  return core::join_names(some);
}

/// Gives every part the medium of its name. One medium fills a mesh of one part whatever they are
/// called.
core::Status bind(const std::map<std::string, bool>& media, const std::string& file,
                  const std::string& mesh, std::vector<ShownPart>& parts) {
  std::vector<std::string> materials;
  bool bound = false;
  for (ShownPart& part : parts) {
    materials.push_back(part.part);
    const auto found = media.find(part.part);
    const auto medium = media.size() == 1 && parts.size() == 1 ? media.begin() : found;
    if (medium == media.end()) continue;
    part.medium = medium->first;
    part.has_index = medium->second;
    bound = true;
  }
  if (bound) return {};
  std::vector<std::string> names;
  for (const auto& [name, has_index] : media) names.push_back(name);
  return core::Error{file + ": none of its media (" + listed(names) +
                     ") has the name of a material of " + mesh + " (" + listed(materials) + ")"};
}

}  // namespace

std::string safe_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || (!name.empty() && (c == '_' || c == '-' || c == '.'))) {
      name += c;
    } else if (!name.empty()) {
      name += '-';
    }
  }
  return name.empty() ? "mesh" : name.substr(0, 90);
}

core::Result<ShownMesh> show_mesh(const std::string& file, const std::string& media,
                                  core::AssetResolver& assets) {
  auto mesh = core::read_mesh_parts(assets, file);
  if (!mesh) return mesh.error();
  ShownMesh shown;
  std::set<std::string> taken;
  for (const core::MeshPart& part : mesh->parts) {
    shown.bounds.include(part.mesh->bounds);
    ShownPart& added = shown.parts.emplace_back();
    added.part = part.name;
    added.name = safe_name(part.name);
    for (int i = 2; !taken.insert(added.name).second; ++i) {
      added.name = safe_name(part.name) + "-" + std::to_string(i);
    }
  }
  if (shown.bounds.empty()) return core::Error{file + ": the mesh has no triangles"};
  bool looks_known = false;
  for (const std::string& library : mesh->libraries) {
    const auto materials = read_library(library, file, assets);
    if (!materials) return materials.error();
    for (ShownPart& part : shown.parts) {
      const auto found = materials->find(part.part);
      if (found == materials->end()) continue;
      part.look = found->second;
      looks_known = true;
    }
  }
  if (!media.empty()) {
    const auto known = read_media(media, assets);
    if (!known) return known.error();
    if (auto done = bind(*known, media, file, shown.parts); !done) return done.error();
  }
  if (shown.parts.size() == 1 || (media.empty() && !looks_known)) {
    shown.parts.resize(1);
    shown.parts.front().part.clear();
    shown.parts.front().name = "mesh";
  }
  return shown;
}

}  // namespace hyades::cli
