#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/lights/light_importance.h"
#include "core/lights/light_selector.h"
#include "core/lights/light_tree.h"

namespace hyades::core {
namespace {

/// Random numbers are multiples of 2^-24. Each light of the tree owns a run of them, so that the
/// probability that is told is exactly the one it comes with.
constexpr float kSteps = 0x1p24F;
constexpr uint32_t kAllSteps = 1U << 24U;

/// How many of `steps` the first of two children gets. Each light whose importance is not known to
/// be 0 keeps at least one.
uint32_t share_of_first(uint32_t steps, float first, float second, const LightTreeNode& one,
                        const LightTreeNode& other) {
  if (!(first > 0.0F) && !(second > 0.0F)) {  // what the parent hoped for is in neither
    first = one.intensity;
    second = other.intensity;
  }
  if (!(second > 0.0F)) return steps;
  if (!(first > 0.0F)) return 0;
  const uint32_t spare = steps - one.count() - other.count();
  const double share = double{first} / (double{first} + double{second});
  return one.count() + static_cast<uint32_t>(static_cast<double>(spare) * share);
}

/// How often a node that is near is looked into before it is judged.
constexpr int kLookAhead = 2;

/// The importance of a node; of one that is near, that of its children's together: an estimate for
/// all of them could miss that one of many is right here.
template <class Importance>
float look_into(const LightTree& tree, const LightTreeNode& node, const Importance& importance,
                int levels) {
  if (levels == 0 || node.is_leaf()) return importance(node);
  if (!importance.near(node)) return importance(node);
  return look_into(tree, tree.child(node, false), importance, levels - 1) +
         look_into(tree, tree.child(node, true), importance, levels - 1);
}

struct AtPoint {
  const Vec3& from;
  const Vec3& normal;
  float operator()(const LightTreeNode& node) const {
    return importance::at_point(node, from, normal);
  }
  bool near(const LightTreeNode& node) const {
    const Vec3 way = node.center - from;
    return glm::dot(way, way) < 4.0F * node.radius2;
  }
};

struct AlongWay {
  const Ray& way;
  float length;
  float operator()(const LightTreeNode& node) const {
    return importance::along_way(node, way, length);
  }
  bool near(const LightTreeNode&) const { return false; }
};

/// What an infinite light brings to a surface that faces all of it [W/m^2, luminance].
double irradiance_of(const Light& light) {
  constexpr int kSide = 8;
  double sum = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 u = (Vec2(i % kSide, i / kSide) + 0.5F) / static_cast<float>(kSide);
    const auto sample = light.sample_direct(Vec3(0.0F), 0.0F, 0.5F, u);
    if (sample) sum += static_cast<double>(luminance(sample->radiance) / sample->pdf);
  }
  return sum / (kSide * kSide);
}

class TreeSelector : public LightSelector {
 public:
  explicit TreeSelector(const std::vector<LightPtr>& lights)
      : emitters_(make_power_selector(lights)), infinite_place_(lights.size(), 0) {
    std::vector<LightTree::Entry> entries;
    std::vector<double> powers;
    double sum = 0.0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Light& light = *lights[i];
      if (const auto bounds = light.bounds()) entries.push_back({i, *bounds});
      if (!light.is_infinite() || !(light.power() > 0.0F)) continue;
      infinite_.push_back(i);
      infinite_place_[i] = static_cast<uint32_t>(infinite_.size());
      sum += static_cast<double>(std::min(light.power(), 1e37F));
      powers.push_back(sum);
    }
    for (const double power : powers) up_to_.push_back(power / sum);
    for (const uint32_t i : infinite_) irradiance_ += irradiance_of(*lights[i]);
    has_tree_ = !entries.empty();
    tree_ = LightTree(std::move(entries), lights.size());
  }

  bool empty() const override { return emitters_->empty(); }

  std::optional<SelectedLight> select(const Vec3& from, const Vec3& normal,
                                      float u) const override {
    return select_by(u, AtPoint{from, normal});
  }

  float probability(const Vec3& from, const Vec3& normal, uint32_t light) const override {
    return probability_by(light, AtPoint{from, normal});
  }

  std::optional<SelectedLight> select_along(const Ray& way, float length, float u) const override {
    return select_by(u, AlongWay{way, length});
  }

  float probability_along(const Ray& way, float length, uint32_t light) const override {
    return probability_by(light, AlongWay{way, length});
  }

  std::optional<SelectedLight> select_emitter(float u) const override {
    return emitters_->select_emitter(u);
  }

  float emitter_probability(uint32_t light) const override {
    return emitters_->emitter_probability(light);
  }

 private:
  /// How the numbers are shared out at a place: the tree's steps come first.
  struct Shares {
    uint32_t tree = 0;
    uint32_t first = 0;  ///< of the tree's, of its root's first child
  };

  template <class Importance>
  Shares shares_at(const Importance& importance) const {
    if (!has_tree_) return {};
    const LightTreeNode& root = tree_.root();
    const bool alone = infinite_.empty();
    if (root.is_leaf()) {
      return {alone ? kAllSteps : steps_of_tree(importance, importance(root)), 0};
    }
    const LightTreeNode& one = tree_.child(root, false);
    const LightTreeNode& other = tree_.child(root, true);
    const float first = look_into(tree_, one, importance, kLookAhead);
    const float second = look_into(tree_, other, importance, kLookAhead);
    const uint32_t steps = alone ? kAllSteps : steps_of_tree(importance, first + second);
    return {steps, share_of_first(steps, first, second, one, other)};
  }

  /// Half, and up to a half of that more or less by what lamps and skies may bring to the place.
  /// What stands between is not known: neither may be left to chance.
  uint32_t steps_of_tree(const AtPoint&, float expected) const {
    const double lamps = expected > 0.0F ? std::min(static_cast<double>(expected), 1e30) : 0.0;
    const double both = lamps + irradiance_;
    const double share = both > 0.0 ? lamps / both : 0.5;
    return static_cast<uint32_t>((0.25 + 0.5 * share) * double{kSteps});
  }
  /// Along a way the tree tells of no irradiance.
  static uint32_t steps_of_tree(const AlongWay&, float) { return kAllSteps / 2; }

  /// Where the run of infinite light `place` begins among `steps`, of which each has one at least.
  uint32_t begin_of(uint32_t place, uint32_t steps) const {
    const auto count = static_cast<uint32_t>(infinite_.size());
    if (place == 0) return 0;
    if (place == count) return steps;
    return place + static_cast<uint32_t>(static_cast<double>(steps - count) * up_to_[place - 1]);
  }

  template <class Importance>
  std::optional<SelectedLight> select_by(float u, const Importance& importance) const {
    if (!has_tree_ && infinite_.empty()) return std::nullopt;
    auto step = static_cast<uint32_t>(std::clamp(u, 0.0F, 0x1.fffffep-1F) * kSteps);
    const Shares shares = shares_at(importance);
    if (step >= shares.tree) {
      step -= shares.tree;
      const uint32_t rest = kAllSteps - shares.tree;
      uint32_t place = 0;
      while (begin_of(place + 1, rest) <= step) ++place;
      return SelectedLight{infinite_[place], probability_of_infinite(place, rest)};
    }
    uint32_t steps = shares.tree;
    const LightTreeNode* node = &tree_.root();
    while (!node->is_leaf()) {
      const LightTreeNode& one = tree_.child(*node, false);
      const LightTreeNode& other = tree_.child(*node, true);
      const uint32_t first = first_steps(*node, one, other, steps, shares, importance);
      const bool second = step >= first;
      if (second) step -= first;
      steps = second ? steps - first : first;
      node = second ? &other : &one;
    }
    return SelectedLight{node->child, static_cast<float>(steps) / kSteps};
  }

  template <class Importance>
  float probability_by(uint32_t light, const Importance& importance) const {
    if (light >= infinite_place_.size()) return 0.0F;
    const uint32_t place = infinite_place_[light];
    if (place == 0 && !(has_tree_ && tree_.holds(light))) return 0.0F;
    const Shares shares = shares_at(importance);
    if (place > 0) return probability_of_infinite(place - 1, kAllSteps - shares.tree);
    uint64_t way = tree_.way_to(light);
    uint32_t steps = shares.tree;
    const LightTreeNode* node = &tree_.root();
    while (!node->is_leaf() && steps > 0) {
      const LightTreeNode& one = tree_.child(*node, false);
      const LightTreeNode& other = tree_.child(*node, true);
      const uint32_t first = first_steps(*node, one, other, steps, shares, importance);
      const bool second = (way & 1U) != 0;
      steps = second ? steps - first : first;
      node = second ? &other : &one;
      way >>= 1U;
    }
    return static_cast<float>(steps) / kSteps;
  }

  template <class Importance>
  uint32_t first_steps(const LightTreeNode& node, const LightTreeNode& one,
                       const LightTreeNode& other, uint32_t steps, const Shares& shares,
                       const Importance& importance) const {
    if (&node == &tree_.root()) return shares.first;
    return share_of_first(steps, look_into(tree_, one, importance, kLookAhead),
                          look_into(tree_, other, importance, kLookAhead), one, other);
  }

  float probability_of_infinite(uint32_t place, uint32_t steps) const {
    return static_cast<float>(begin_of(place + 1, steps) - begin_of(place, steps)) / kSteps;
  }

  std::unique_ptr<LightSelector> emitters_;  ///< for light paths
  LightTree tree_;
  bool has_tree_ = false;
  std::vector<uint32_t> infinite_;        ///< these lights
  std::vector<double> up_to_;             ///< part of their power that they have with all before
  std::vector<uint32_t> infinite_place_;  ///< by light: its place in infinite_, plus 1; 0: none
  double irradiance_ = 0.0;               ///< of all infinite lights, straight on [W/m^2]
};

}  // namespace

std::unique_ptr<LightSelector> make_tree_selector(const std::vector<LightPtr>& lights) {
  return std::make_unique<TreeSelector>(lights);
}

}  // namespace hyades::core
