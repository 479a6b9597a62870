#pragma once

#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "core/base/result.h"

/// What a glTF file names: bytes within the text (data: URIs), or files beside it.
namespace hyades::core {

bool is_data_uri(std::string_view uri);

/// The bytes that a data: URI holds; error where it is not in base64.
Result<Bytes> decode_data_uri(std::string_view uri);

/// "image/png" of "data:image/png;base64,..."; empty where it says nothing.
std::string data_uri_type(std::string_view uri);

/// The file that a relative URI names, %20 and the like decoded. Errors: an absolute path, those of
/// within_folder(); without
/// "." and "..".
Result<std::string> decode_file_uri(std::string_view uri);

}  // namespace hyades::core
