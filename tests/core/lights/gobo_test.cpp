#include "core/lights/gobo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/chi_squared.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

std::shared_ptr<const Image> random_picture(int width, int height, uint64_t seed) {
  test::Random random(seed);
  auto image = std::make_shared<Image>(make_image(width, height, {"R", "G", "B"}));
  for (float& value : image->data) value = random.uniform() < 0.2F ? 0.0F : random.uniform();
  return image;
}

TEST(Gobo, ShowsItsPixelsAtTheirCentresAndTheirMeanBetween) {
  const auto image = random_picture(4, 3, 2);
  const Gobo gobo(image);
  const auto pixel = [&](int x, int y) {
    return Rgb(image->at(x, y, 0), image->at(x, y, 1), image->at(x, y, 2));
  };
  const auto near = [](const Rgb& a, const Rgb& b) {
    return max_component(glm::abs(a - b)) < 1e-5F;
  };
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Vec2 middle((static_cast<float>(x) + 0.5F) / 4.0F,
                        (static_cast<float>(y) + 0.5F) / 3.0F);
      EXPECT_TRUE(near(gobo.view(middle).value, pixel(x, y))) << x << ", " << y;
      if (x == 3) continue;
      EXPECT_TRUE(near(gobo.view(middle + Vec2(0.125F, 0.0F)).value,
                       0.5F * (pixel(x, y) + pixel(x + 1, y))));
    }
  }
  EXPECT_TRUE(near(gobo.view({0.0F, 0.0F}).value, pixel(0, 0)));
  EXPECT_TRUE(near(gobo.view({1.0F, 1.0F}).value, pixel(3, 2)));
  EXPECT_EQ(gobo.half_size(), Vec2(4.0F / 3.0F, 1.0F));
}

TEST(Gobo, PlacesFollowTheirDensity) {
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {5, 7}, {64, 3}}) {
    SCOPED_TRACE(width);
    const Gobo gobo(random_picture(width, height, 5));
    // Cells of 24 x 24, each with the integral of the density over it.
    constexpr int kSide = 24;
    constexpr int kParts = 12;
    std::vector<double> shares;
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        double sum = 0.0;
        for (int k = 0; k < kParts * kParts; ++k) {
          const Vec2 place(
              (static_cast<float>(i) + (static_cast<float>(k % kParts) + 0.5F) / kParts) / kSide,
              (static_cast<float>(j) + (static_cast<float>(k / kParts) + 0.5F) / kParts) / kSide);
          sum += static_cast<double>(gobo.view(place).pdf);
        }
        shares.push_back(sum / (kParts * kParts * kSide * kSide));
      }
    }
    double whole = 0.0;
    for (const double share : shares) whole += share;
    EXPECT_NEAR(whole, 1.0, 5e-3);
    constexpr int kCount = 400000;
    std::vector<double> observed(shares.size(), 0.0);
    test::Random random(7);
    for (int n = 0; n < kCount; ++n) {
      const Vec2 place = gobo.sample(random.uniform2());
      ASSERT_TRUE(place.x >= 0.0F && place.x <= 1.0F && place.y >= 0.0F && place.y <= 1.0F);
      const int i = std::min(static_cast<int>(place.x * kSide), kSide - 1);
      const int j = std::min(static_cast<int>(place.y * kSide), kSide - 1);
      observed[static_cast<size_t>(j * kSide + i)] += 1.0;
    }
    for (double& share : shares) share *= kCount / whole;
    EXPECT_GT(test::chi_squared(observed, shares).p, 1e-4);
  }
}

TEST(Gobo, TakesWhatIsNoLightForBlack) {
  auto image = std::make_shared<Image>(make_image(2, 1, {"Y"}));
  image->data = {-3.0F, std::numeric_limits<float>::quiet_NaN()};
  const Gobo dark(image);
  EXPECT_EQ(dark.view({0.25F, 0.5F}).value, Rgb(0.0F));
  EXPECT_EQ(dark.view({0.75F, 0.5F}).pdf, 0.0F);
}

TEST(Gobo, LooksItselfOver) {
  auto image = std::make_shared<Image>(make_image(130, 65, {"Y"}));
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 130; ++x) image->at(x, y, 0) = x < 65 ? 1.0F : 3.0F;
  }
  const Gobo gobo(image);
  const std::vector<Rgb>& seen = gobo.overview();
  ASSERT_EQ(seen.size(), size_t{64} * 64);
  EXPECT_FLOAT_EQ(seen.front().x, 1.0F);
  EXPECT_FLOAT_EQ(seen.back().z, 3.0F);
  const Gobo small(random_picture(3, 2, 9));
  for (const Rgb& value : small.overview()) {
    EXPECT_TRUE(min_component(value) >= 0.0F && max_component(value) <= 1.0F);
  }
}

}  // namespace
}  // namespace hyades::core
