// Pictures of an independent renderer: means of every channel and of 16x16-pixel blocks must agree.
// docs/testing.md tells where the references come from.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/test_quarter.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

constexpr int kBlock = 16;

struct Block {
  std::array<double, 3> mean{};
  std::array<double, 3> sigma{};  ///< standard error of the mean
};

std::vector<Block> read_blocks(const std::string& path) {
  std::ifstream file(path);
  std::vector<Block> blocks;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Block b;
    words >> b.mean[0] >> b.mean[1] >> b.mean[2] >> b.sigma[0] >> b.sigma[1] >> b.sigma[2];
    blocks.push_back(b);
  }
  return blocks;
}

std::vector<Block> blocks_of(const core::Image& picture) {
  const int columns = picture.width / kBlock;
  std::vector<Block> blocks(static_cast<size_t>(columns * (picture.height / kBlock)));
  const int variance = picture.find_channel("variance.R");
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      Block& b = blocks[static_cast<size_t>(y / kBlock * columns + x / kBlock)];
      for (int c = 0; c < 3; ++c) {
        b.mean[static_cast<size_t>(c)] += static_cast<double>(picture.at(x, y, c));
        b.sigma[static_cast<size_t>(c)] += static_cast<double>(picture.at(x, y, variance + c));
      }
    }
  }
  for (Block& b : blocks) {
    for (size_t c = 0; c < 3; ++c) {
      b.mean[c] /= kBlock * kBlock;
      b.sigma[c] = std::sqrt(b.sigma[c]) / (kBlock * kBlock);
    }
  }
  return blocks;
}

// Where the shared folder is not here every reference failed, also those that need nothing of it.
TEST(SharedFolder, IsNotAskedForWhereNothingOfItIsNamed) {
  const char* const before = std::getenv("HYADES_SHARED");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("HYADES_SHARED", "/nowhere", 1);
  EXPECT_EQ(shared_folder(), "");
  EXPECT_EQ(with_shared_folder("name: alone"), "name: alone");
  ::setenv("HYADES_SHARED", kept.c_str(), 1);
  if (before == nullptr) ::unsetenv("HYADES_SHARED");
}

/// What a scene is allowed, besides the general rule.
struct Reference {
  const char* name;
  uint32_t samples;
  double outside = 0.01;  ///< share of blocks that may lie beyond 4 sigma and 2 %
  double worst = 0.10;    ///< relative difference that no block may exceed
};

void PrintTo(const Reference& reference, std::ostream* out) { *out << reference.name; }

// rough-glass is known to disagree in a ring along the edge of the ball of alpha 0.1 (by 3 to 7 %;
// the reference is the darker one; centre, the rougher ball, floor and mean agree): docs/testing.md
// tells what has been ruled out.
// In an order in which every fourth ones take about as long.
const Reference kReferences[] = {{"rough-glass", 256, 0.08, 0.13},
                                 {"fog-room", 128},
                                 {"subsurface-grey", 96},
                                 {"box-glass-mirror", 192},
                                 {"lens", 64},
                                 {"env-bunny-gold", 64},
                                 {"box-grey", 96},
                                 {"box-diffuse", 96}};

class References : public testing::TestWithParam<Reference> {};

// Every channel's mean within 3 sigma or 0.5 %; 99 % of the blocks within 4 sigma or 2 %; no block
// off by more than 10 %. The mean's own error is far below 0.5 % at these samples, so a picture
// that is off by 1 % fails.
TEST_P(References, Agree) {
  const Reference& reference = GetParam();
  if (!in_quarter(kReferences, reference.name)) GTEST_SKIP() << kOtherQuarter;
  const std::string base = std::string("tests/references/") + reference.name;
  std::ifstream file(base + ".yaml");
  std::stringstream yaml;
  yaml << file.rdbuf();
  if (yaml.str().find("shared/assets") != std::string::npos && shared_folder().empty()) {
    GTEST_SKIP() << reference.name << " needs ../shared/assets, which is not here";
  }
  std::string text = with_shared_folder(yaml.str());
  text.replace(text.find("samples: 512"), 12, "samples: " + std::to_string(reference.samples));
  const YamlScene scene(text, 1, {}, "tests/references");
  const core::RenderedFrame frame = scene.render();
  EXPECT_EQ(frame.counters.bad_samples, 0U);

  const std::vector<Block> ours = blocks_of(frame.film.normalised());
  const std::vector<Block> theirs = read_blocks(base + ".blocks");
  ASSERT_EQ(ours.size(), theirs.size());
  const auto count = static_cast<double>(ours.size());
  int outside = 0;
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0.0;
    double expected = 0.0;
    double variance = 0.0;
    for (size_t i = 0; i < ours.size(); ++i) {
      mean += ours[i].mean[c] / count;
      expected += theirs[i].mean[c] / count;
      const double block_variance =
          ours[i].sigma[c] * ours[i].sigma[c] + theirs[i].sigma[c] * theirs[i].sigma[c];
      variance += block_variance / (count * count);
      const double difference = std::abs(ours[i].mean[c] - theirs[i].mean[c]);
      if (difference > std::max(4.0 * std::sqrt(block_variance), 0.02 * theirs[i].mean[c]))
        ++outside;
      EXPECT_LE(difference,
                std::max(reference.worst * theirs[i].mean[c], 4.0 * std::sqrt(block_variance)))
          << "block " << i % 16 << "," << i / 16 << " channel " << c << ": " << ours[i].mean[c]
          << ", expected " << theirs[i].mean[c];
    }
    RecordProperty("channel" + std::to_string(c), std::to_string(mean / expected));
    EXPECT_NEAR(mean, expected, std::max(3.0 * std::sqrt(variance), 0.005 * expected))
        << "channel " << c;
    EXPECT_LT(std::sqrt(variance), 0.0025 * expected) << "underpowered: take more samples";
  }
  EXPECT_LE(outside, reference.outside * 3.0 * count) << "blocks beyond 4 sigma and 2 %";
}

INSTANTIATE_TEST_SUITE_P(Scenes, References, testing::ValuesIn(kReferences), [](const auto& scene) {
  std::string name = scene.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace hyades::test
