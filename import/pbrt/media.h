#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts the media that something uses into Context::media, each once.
class Media {
 public:
  explicit Media(Context& context);

  /// The job's name of a medium of the scene in a body whose space `body` brings to the scene's;
  /// empty where `name` is, and, with an error of the report, where there is none of that name.
  std::string named(const std::string& name, const Mat4d& body, const Place& place);

 private:
  Context& context_;
  std::map<std::string, size_t> by_name_;
  std::map<std::string, std::string> written_;  ///< by name, and body where that matters
};

/// The medium of a subsurface material; its name.
std::string add_subsurface_medium(Context& context, ParameterReader& material, float scale, float g,
                                  const std::string& wish);

}  // namespace hyades::core::pbrt
