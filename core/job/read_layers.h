#pragma once

#include <string_view>
#include <vector>

#include "core/job/job.h"
#include "core/job/map_reader.h"

namespace hyades::core {

/// Whether `item` names a layer that this job can have; complains where not.
bool check_layer(MapReader& reader, const YamlNode& item);

/// Reads key `layers` of an output of EXR: names that the job knows, folded ones as what they stand
/// for.
void read_layers(MapReader& reader, OutputDesc& output);

/// In the name of an EXR file: one file for each layer.
inline constexpr std::string_view kLayerMark = "{layer}";

/// One output for each of its layers, where the file's name asks for that (kLayerMark); else
/// itself.
std::vector<OutputDesc> split_by_layer(const Job& job, const OutputDesc& output);

}  // namespace hyades::core
