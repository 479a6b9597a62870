#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "core/base/assets.h"
#include "core/base/atomic_file.h"

namespace hyades::coordinator {

/// Writes `json` to the file `path`, complete or not at all.
inline core::Status write_json(const std::string& path, const nlohmann::json& json) {
  const std::string text = json.dump(2);
  return core::write_file(path, std::as_bytes(std::span(text)));
}

/// Reads the file; an error where it cannot be read or is not JSON.
inline core::Result<nlohmann::json> read_json(const std::string& path) {
  auto bytes = core::map_file(path);
  if (!bytes) return bytes.error().in(path);
  nlohmann::json json =
      nlohmann::json::parse(bytes->chars(), bytes->chars() + bytes->size(), nullptr, false);
  if (json.is_discarded()) return core::Error{path + ": not JSON"};
  return json;
}

}  // namespace hyades::coordinator
