#include "jobs/generator/scatter.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/base/hash.h"
#include "core/base/vec.h"

namespace hyades::gallery {
namespace {

using core::Vec3;

/// The numbers of one scattering, each 0..1.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : seed_(seed) {}
  float next() {
    return static_cast<float>(core::mix64(core::hash_combine(seed_, count_++)) >> 40) * 0x1p-24F;
  }
  float between(float a, float b) { return a + (b - a) * next(); }

 private:
  uint64_t seed_;
  uint64_t count_ = 0;
};

bool keeps_clear(const Vec3& place, const std::vector<Vec3>& others, float distance) {
  for (const Vec3& other : others) {
    if (glm::length(place - other) < distance) return false;
  }
  return true;
}

}  // namespace

std::string lanterns() {
  constexpr float kSide = 8.0F, kTop = 7.0F, kClear = 1.1F;
  const char* const papers[] = {"paper_1", "paper_2", "paper_3", "paper_4"};
  Numbers numbers(2026);
  std::vector<Vec3> places;
  while (places.size() < 100) {
    const Vec3 place(numbers.between(-kSide, kSide), kTop * numbers.next() * numbers.next(),
                     numbers.between(-kSide, kSide));
    if (keeps_clear(place, places, kClear)) places.push_back(place);
  }
  std::string text =
      "# A hundred lanterns, made by jobs/generator.\n"
      "groups:\n  flock:\n    objects:\n";
  for (size_t i = 0; i < places.size(); ++i) {
    const Vec3& p = places[i];
    text += fmt::format(
        "      lamp_{}: {{shape: cylinder, radius: 0.13, height: 0.3, caps: false, at: [{:.2f}, "
        "{:.2f}, "
        "{:.2f}], "
        "transform: [{{rotate_x: {:.0f}}}, {{rotate_z: {:.0f}}}], emit: {{color: {}, power: "
        "{:.1f}}}}}\n",
        i + 1, p.x, p.y + 0.15F, p.z, numbers.between(-9.0F, 9.0F), numbers.between(-9.0F, 9.0F),
        papers[i * 7 % 4], numbers.between(5.0F, 11.0F));
  }
  return text;
}

std::string spray_of_leaves() {
  Numbers numbers(7);
  std::string text =
      "# A stem with leaves, made by jobs/generator.\n"
      "groups:\n  spray:\n    objects:\n";
  const auto stem = [](float h) {
    return Vec3(0.09F * std::sin(4.0F * h), h, 0.07F * std::sin(3.1F * h + 1.0F));
  };
  constexpr int kPieces = 12, kLeaves = 60;
  constexpr float kHeight = 1.2F, kDegrees = 57.29578F;
  for (int i = 0; i < kPieces; ++i) {
    const Vec3 from = stem(kHeight * static_cast<float>(i) / kPieces);
    const Vec3 way = stem(kHeight * static_cast<float>(i + 1) / kPieces) - from;
    const float length = glm::length(way);
    // From y to the piece's direction.
    const float tilt = std::acos(way.y / length) * kDegrees;
    const float turn = std::atan2(way.x, way.z) * kDegrees;
    text += fmt::format(
        "      stem_{}: {{shape: cylinder, radius: {:.4f}, height: {:.4f}, material: bark, "
        "transform: [{{rotate_x: {:.2f}}}, {{rotate_y: {:.2f}}}], at: [{:.4f}, {:.4f}, {:.4f}]}}\n",
        i + 1, 0.011F - 0.0006F * static_cast<float>(i), length * 1.04F, tilt, turn, from.x, from.y,
        from.z);
  }
  for (int i = 0; i < kLeaves; ++i) {
    const float h = kHeight * (0.06F + 0.94F * (static_cast<float>(i) + numbers.next()) / kLeaves);
    const Vec3 foot = stem(h);
    // A square in y = 0, its edge at the stem, lifted and turned about it.
    text += fmt::format(
        "      leaf_{}: {{shape: rectangle, size: [0.16, 0.16], material: leaf, transform: "
        "[{{translate: [0, 0, 0.085]}}, {{scale: {:.2f}}}, {{rotate_z: {:.0f}}}, {{rotate_x: "
        "{:.0f}}}, "
        "{{rotate_y: {:.0f}}}], at: [{:.4f}, {:.4f}, {:.4f}]}}\n",
        i + 1, numbers.between(0.65F, 1.15F), numbers.between(-30.0F, 30.0F),
        numbers.between(-25.0F, 40.0F),
        137.5F * static_cast<float>(i) + numbers.between(-25.0F, 25.0F), foot.x, foot.y, foot.z);
  }
  return text;
}

}  // namespace hyades::gallery
