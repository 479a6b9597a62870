#pragma once

#include <cstdint>
#include <string>

namespace hyades::core {

/// `file` with each run of # replaced by the frame number, padded with zeros to the run's length
/// ("a.####.exr", 7 -> "a.0007.exr"). Unchanged where there is no #.
std::string output_path(const std::string& file, int32_t frame);

/// What the name of a file below the folder of a job's outputs is like.
enum class OutputName : uint8_t {
  plain,
  outside,   ///< not below the folder: absolute, or with a part ".."
  reserved,  ///< in .hyades, which is removed with a run's log
  special,   ///< a part begins with '.', and is hidden, or '-', which programs take for an option
};

/// What `file`, which may have # for the frame's number, is like.
OutputName output_name(const std::string& file);

/// ".exr" of "a/b.EXR"; "" where there is none.
std::string file_extension(const std::string& file);

/// Whether one of two outputs of a frame would have to be a folder that the other lies in.
bool nested_output_paths(const std::string& a, const std::string& b);

/// The place of the files of an output among those of others: outputs that write the same files
/// have the same one, and its folders are its beginnings, with '\0' behind each.
std::string place_of_output(const std::string& file);

/// Whether two outputs write the same files (for every frame the same ones).
bool same_output_path(const std::string& a, const std::string& b);

}  // namespace hyades::core
