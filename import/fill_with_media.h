#pragma once

#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// A file of media.
struct MediaFile {
  std::string reference;  ///< as a resolver knows it
  std::string in_job;     ///< as the job names it
};

/// The sections of a scene, its objects filled with the media of file `media` that have the names
/// of their parts (materials of a mesh's file) or materials: as `interior`, with the surface of the
/// medium's index of refraction, or none where it has none (a material that lets light through, as
/// glass, stays). One medium fills an only object whatever they are called. Errors: the file's own,
/// and no medium that fits; they name both sides. `scene`: what is filled, for the message.
Result<YamlPtr> fill_with_media(const YamlNode& sections, const MediaFile& media,
                                const std::string& scene, AssetResolver& files);

}  // namespace hyades::core
