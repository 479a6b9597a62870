#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/job/camera_desc.h"
#include "core/job/color_desc.h"
#include "core/job/curve.h"
#include "core/job/light_desc.h"
#include "core/job/material_desc.h"
#include "core/job/medium_desc.h"
#include "core/job/object_desc.h"
#include "core/job/output_desc.h"
#include "core/job/sampling_desc.h"
#include "core/job/texture_desc.h"
#include "core/job/value_checks.h"

/// A job as plain structs: what the YAML says, validated, with defaults filled in and names still
/// names. The in-class defaults are the documented ones (docs/job.md). Lengths are in metres after
/// `units` has been applied by the scene builder; angles in degrees.
namespace hyades::core {

struct Job {
  std::string file;                   ///< path of the YAML; relative references start at its folder
  std::vector<std::string> includes;  ///< files of `include:` and of media, relative to its folder
  std::string name;
  float units = 1.0F;  ///< metres per unit of length in the job
  FramesDesc frames;
  FilmDesc film;
  SamplingDesc sampling;
  IntegratorDesc integrator;
  RenderDesc render;
  CameraDesc camera;
  std::vector<TextureDesc> textures;
  std::vector<MaterialDesc> materials;
  std::vector<MediumDesc> media;
  std::vector<GroupDesc> groups;
  std::vector<ObjectDesc> objects;
  std::vector<LightDesc> lights;
  std::optional<EnvironmentDesc> environment;
  std::string atmosphere;           ///< name in Job::media of what fills all space; empty: nothing
  std::optional<ColorDesc> color;   ///< of pictures for displays, in place of their tone_map
  std::vector<OutputDesc> outputs;  ///< of each frame
  std::vector<VideoDesc> videos;    ///< of all frames, made of some of `outputs`
  std::string denoise = "false";    ///< of outputs that do not say: false | true | features | oidn
  bool keep_films = false;          ///< each finished frame's film stays, as film_file() says
  std::vector<Curve> curves;        ///< all values that it writes and that may change over frames
  ValueChecks checks;  ///< what its animated values must keep to at every frame (check_frame)

  /// The moment at which frame `frame`'s shutter is open for fraction `shutter_time` (0..1).
  JobTime time_of(int32_t frame, float shutter_time = 0.0F) const {
    const double at = frame + double{shutter_time} * double{frames.shutter};
    return {(at - 1.0) / double{frames.fps}, at};
  }
};

/// Calls `visit` with every object that is written among `objects`, and with those of groups that
/// are written in place among them.
template <class Visit>
void for_each_object(const std::vector<ObjectDesc>& objects, const Visit& visit) {
  for (const ObjectDesc& object : objects) {
    visit(object);
    for_each_object(object.children, visit);
  }
}

/// Calls `visit` with every object that is written in the job, those of its groups too.
template <class Visit>
void for_each_object(const Job& job, const Visit& visit) {
  for_each_object(job.objects, visit);
  for (const GroupDesc& group : job.groups) for_each_object(group.objects, visit);
}

}  // namespace hyades::core
