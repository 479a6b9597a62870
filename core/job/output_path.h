#pragma once

#include <cstdint>
#include <string>

namespace hyades::core {

/// `file` with each run of # replaced by the frame number, padded with zeros to the run's length
/// ("a.####.exr", 7 -> "a.0007.exr"). Unchanged where there is no #.
std::string output_path(const std::string& file, int32_t frame);

/// ".exr" of "a/b.EXR"; "" where there is none.
std::string file_extension(const std::string& file);

/// Whether one of two outputs of a frame would have to be a folder that the other lies in.
bool nested_output_paths(const std::string& a, const std::string& b);

/// Whether two outputs write the same files (for every frame the same ones).
bool same_output_path(const std::string& a, const std::string& b);

}  // namespace hyades::core
