#include "core/job/curve.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/job/job.h"

namespace hyades::core {
namespace {

constexpr size_t kWidth = 64;  ///< of the little pictures, in characters

std::vector<float> numbers(float value) { return {value}; }
std::vector<float> numbers(const Vec2& v) { return {v.x, v.y}; }
std::vector<float> numbers(const Vec3& v) { return {v.x, v.y, v.z}; }
std::vector<float> numbers(const Vec4& v) { return {v.x, v.y, v.z, v.w}; }

std::vector<int32_t> frames_of(const FramesDesc& frames) {
  std::vector<int32_t> all;
  for (int64_t f = frames.first; f <= frames.last; f += frames.step)
    all.push_back(static_cast<int32_t>(f));
  return all;
}

std::string little_picture(const std::vector<float>& values, float low, float high) {
  static constexpr std::array<const char*, 8> kLevels = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const size_t width = std::min(values.size(), kWidth);
  std::string text;
  for (size_t i = 0; i < width; ++i) {
    const float value = values[width < 2 ? 0 : i * (values.size() - 1) / (width - 1)];
    const float place = high > low ? (value - low) / (high - low) : 0.0F;
    text += kLevels[static_cast<size_t>(std::clamp(place * 7.0F + 0.5F, 0.0F, 7.0F))];
  }
  return text;
}

/// "5 values": those that begin like `path`, or all, or what they begin with where they are many.
std::string what_there_is(const Job& job, const std::string& path) {
  constexpr size_t kMost = 12;
  std::vector<std::string> names;
  for (const Curve& curve : job.curves) names.push_back(curve.path);
  if (names.empty()) return "; the job writes no values that could change";
  if (const std::string hint = did_you_mean(path, names); !hint.empty() && names.size() > kMost)
    return hint;
  const std::string section = path.substr(0, path.find('.')) + ".";
  std::vector<std::string> near;
  for (const std::string& name : names) {
    if (name.starts_with(section)) near.push_back(name);
  }
  if (near.empty()) near = names;
  std::sort(near.begin(), near.end());
  std::string text = "; there is ";
  const size_t shown = std::min(near.size(), kMost);
  for (size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + near[i];
  if (near.size() > shown) text += fmt::format(" and {} more", near.size() - shown);
  return text;
}

}  // namespace

std::vector<float> Curve::at(const JobTime& time) const {
  return std::visit([&](const auto& animated) { return numbers(animated.at(time)); }, value);
}

bool Curve::is_constant() const {
  return std::visit([](const auto& animated) { return animated.is_constant(); }, value);
}

Result<const Curve*> find_curve(const Job& job, const std::string& path) {
  for (const Curve& curve : job.curves) {
    if (curve.path == path) return &curve;
  }
  return Error{fmt::format("the job writes no value '{}' that could change over the frames{}",
                           path.substr(0, 100), what_there_is(job, path))};
}

std::string curve_table(const Job& job, const Curve& curve) {
  const std::vector<int32_t> frames = frames_of(job.frames);
  std::vector<std::vector<float>> rows;
  for (const int32_t frame : frames) rows.push_back(curve.at(job.time_of(frame)));
  std::string text = curve.path + (curve.is_constant() ? " does not change\n" : "\n");
  const size_t components = rows.empty() ? 0 : rows[0].size();
  for (size_t c = 0; c < components; ++c) {
    std::vector<float> values;
    for (const auto& row : rows) values.push_back(row[c]);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += fmt::format("  {}  {:.6g} to {:.6g}\n", little_picture(values, *low, *high),
                        double{*low}, double{*high});
  }
  text += "   frame  value\n";
  for (size_t i = 0; i < frames.size(); ++i) {
    text += fmt::format("{:8}  ", frames[i]);
    for (size_t c = 0; c < components; ++c)
      text += fmt::format("{}{:.6g}", c == 0 ? "" : "  ", double{rows[i][c]});
    text += '\n';
  }
  return text;
}

}  // namespace hyades::core
