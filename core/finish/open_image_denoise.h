#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core {

/// Intel's Open Image Denoise, versions 1 and 2, where its library is found while the program runs:
/// the file that the environment variable HYADES_OIDN names, else libOpenImageDenoise.so.2 or .so.1
/// where the system's loader looks for libraries. It is a neural network: its results are no part
/// of what Hyades promises bits for.
class OpenImageDenoise {
 public:
  /// The error says where it was looked for.
  static Result<OpenImageDenoise> load();

  /// Row by row, `albedo` and `normal` (-1..1) of the same size as `color` or empty.
  struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Rgb> color;
    std::vector<Rgb> albedo;
    std::vector<Rgb> normal;
  };

  /// `picture.color` without noise, or what the library says is wrong.
  Result<std::vector<Rgb>> run(const Picture& picture) const;

 private:
  struct Functions;
  explicit OpenImageDenoise(std::shared_ptr<const Functions> functions)
      : functions_(std::move(functions)) {}
  std::shared_ptr<const Functions> functions_;
};

}  // namespace hyades::core
