#pragma once

#include <span>
#include <string>
#include <vector>

/// The names that a job may give for kinds of things: rows of the tables of those who read them,
/// and the one place that lists them. core/scene, which this room cannot see, has a table of makers
/// for each; a test there holds the two together.
namespace hyades::core {

struct ObjectDesc;

std::vector<std::string> texture_types();
std::vector<std::string> material_types();
std::vector<std::string> light_types();
/// What has a surface: the values of `shape`, and "mesh".
std::vector<std::string> shape_names();
/// Whether a shape is closed, so that something can be inside of it; of meshes it is believed.
bool has_inside(const ObjectDesc& object);

// Of image textures and mappings.
std::span<const std::string> color_space_names();
std::span<const std::string> wrap_names();
std::span<const std::string> texture_filter_names();
std::span<const std::string> mapping_names();
std::span<const std::string> mapping_space_names();
std::span<const std::string> channel_names();

// Of patterns and of what becomes of textures.
std::span<const std::string> cell_metric_names();
std::span<const std::string> cell_feature_names();
std::span<const std::string> gradient_shape_names();
std::span<const std::string> remap_end_names();
std::span<const std::string> ramp_shape_names();

/// The values of a mesh's `normals`.
std::span<const std::string> mesh_normals_names();

}  // namespace hyades::core
