#pragma once

#include <string>
#include <vector>

#include "core/job/source.h"

namespace hyades::core {

/// How light becomes the numbers of a display, by a configuration of OpenColorIO. Empty names mean
/// what the configuration says.
struct ColorDesc {
  SourceLocation where;
  std::string config;              ///< relative to the job's folder
  std::vector<std::string> files;  ///< that it names and that are there, likewise
  std::string display;
  std::string view;
  std::string look;  ///< "a, -b": these looks in place of the view's, in OpenColorIO's words
  std::string working_space;  ///< the config's colour space that light is given to it in
};

}  // namespace hyades::core
