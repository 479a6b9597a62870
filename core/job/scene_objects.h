#pragma once

#include <functional>
#include <string>

#include "core/job/scene_document.h"
#include "core/job/source.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// The tree of a scene's document, wanted at `where`; null after a complaint.
using OpenScene =
    std::function<YamlPtr(SceneDocument wanted, const YamlNode& name, const std::string& what)>;

/// Replaces objects of `root` (a job) that say `gltf: robot.glb`, `pbrt: room.pbrt` or `obj:
/// chair.obj` by groups that hold the objects of the scene, and adds its textures, materials,
/// media, groups and lights to the job's, their names behind that of the object and a dot. What the
/// scene says of the camera, the sky, the film, the frames and the atmosphere is left to the job.
/// An `override` of the object may name the scene's materials as the scene does.
YamlPtr with_scene_objects(const YamlPtr& root, const OpenScene& open, Diagnostics& diagnostics);

/// The frames per second that a job's tree says; the default where it says nothing that reads so.
float fps_of(const YamlNode& root);

}  // namespace hyades::core
