#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec.h"
#include "import/pbrt/color_space.h"
#include "import/pbrt/place.h"

namespace hyades::core::pbrt {

/// "type name" [values] of a directive.
struct Parameter {
  std::string type;  ///< as pbrt-v4 calls it: float, point3, rgb, texture, ...
  std::string name;
  Place place;
  const RgbSpace* space = nullptr;  ///< what its rgb values mean
  bool inherited = false;           ///< from an Attribute directive: may be of no use here
  std::vector<float> numbers;       ///< finite
  std::vector<int32_t> integers;    ///< of type integer
  std::vector<uint8_t> flags;       ///< of type bool
  std::vector<std::string> texts;
};

using ParameterPtr = std::shared_ptr<const Parameter>;

/// The parameters of one thing: its own, then those of Attribute directives around it. Of several
/// of one name the last one that was written counts.
using Parameters = std::vector<ParameterPtr>;

/// Reads parameters and remembers which; a wrong number of values is an error of the report.
class ParameterReader {
 public:
  ParameterReader(const Parameters& parameters, const Place& place, Report& report);

  float number(std::string_view name, float otherwise);
  std::optional<float> number_if(std::string_view name);
  int integer(std::string_view name, int otherwise);
  bool flag(std::string_view name, bool otherwise);
  std::string text(std::string_view name, const std::string& otherwise = {});
  std::span<const std::string> texts(std::string_view name);
  Vec3d triple(std::string_view type, std::string_view name, const Vec3d& otherwise);

  /// All values of a parameter whose type has `of` numbers each; empty where there is none.
  std::span<const float> numbers(std::string_view type, std::string_view name, size_t of = 1);
  std::span<const int32_t> integers(std::string_view name, size_t of = 1);

  /// The parameter of this name and type, or null; counts as read.
  const Parameter* find(std::string_view type, std::string_view name);
  /// The parameter of this name, of any type; counts as read.
  const Parameter* find(std::string_view name);

  /// Notes every parameter that nobody has read.
  void note_unused() const;

  const Place& place() const { return place_; }
  Report& report() { return report_; }

 private:
  const Parameter* one(std::string_view type, std::string_view name, size_t values,
                       size_t (*count)(const Parameter&));

  const Parameters& parameters_;
  const Place& place_;
  Report& report_;
  std::vector<bool> read_;
};

}  // namespace hyades::core::pbrt
