#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/job/map_reader.h"

/// One reader per section of a job; each takes its key from the top-level reader.
namespace hyades::core {

/// The whole job, section by section.
void read_job(MapReader& top, Job& job);

void read_frames(MapReader& top, FramesDesc& frames);
void read_film(MapReader& top, FilmDesc& film);
void read_sampling(MapReader& top, SamplingDesc& sampling);
void read_integrator(MapReader& top, IntegratorDesc& integrator);
void read_render(MapReader& top, RenderDesc& render);
void read_camera(MapReader& top, CameraDesc& camera);
void read_textures(MapReader& top);
void read_materials(MapReader& top);
/// A material called `name`, added to the job.
void read_material(MapReader& reader, const std::string& name);
void read_media(MapReader& top);
void read_groups(MapReader& top);
void read_objects(MapReader& top);
void read_lights(MapReader& top);
void read_environment(MapReader& top, Job& job);
void read_atmosphere(MapReader& top, Job& job);
void read_color_config(MapReader& top, Job& job);
void read_outputs(MapReader& top, Job& job);  ///< after `color`

/// Reads every `name: {...}` of section `key`, with `like` resolved, in the order of the text.
/// `noun` is what one of them is called ("material"); `kind` is set where names may refer to them.
void read_named(MapReader& parent, std::string_view key, const std::string& noun,
                std::optional<NameKind> kind,
                const std::function<void(MapReader& reader, const std::string& name)>& read);

}  // namespace hyades::core
