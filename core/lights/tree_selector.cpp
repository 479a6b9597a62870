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
  const LightTree& tree;
  const Vec3& from;
  const Vec3& normal;
  ListBits lists;
  bool links(const LightTreeNode& node) const { return tree.links(node, lists); }
  float operator()(const LightTreeNode& node) const {
    return links(node) ? importance::at_point(node, from, normal) : 0.0F;
  }
  bool near(const LightTreeNode& node) const {
    const Vec3 way = node.center - from;
    return glm::dot(way, way) < 4.0F * node.radius2;
  }
};

struct AlongWay {
  const LightTree& tree;
  const Ray& way;
  float length;
  ListBits lists;
  bool links(const LightTreeNode& node) const { return tree.links(node, lists); }
  float operator()(const LightTreeNode& node) const {
    return links(node) ? importance::along_way(node, way, length) : 0.0F;
  }
  bool near(const LightTreeNode&) const { return false; }
};

/// How many of `steps` the first of two children gets. Each light whose importance is not known to
/// be 0 keeps at least one.
template <class Importance>
uint32_t share_of_first(uint32_t steps, float first, float second, const LightTreeNode& one,
                        const LightTreeNode& other, const Importance& importance) {
  if (!(first > 0.0F) && !(second > 0.0F)) {  // what the parent hoped for is in neither
    first = importance.links(one) ? one.intensity : 0.0F;
    second = importance.links(other) ? other.intensity : 0.0F;
  }
  if (!(second > 0.0F)) return steps;
  if (!(first > 0.0F)) return 0;
  const uint32_t spare = steps - one.count() - other.count();
  const double share = double{first} / (double{first} + double{second});
  return one.count() + static_cast<uint32_t>(static_cast<double>(spare) * share);
}

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
  TreeSelector(const std::vector<LightPtr>& lights, const std::vector<uint8_t>& receivers)
      : emitters_(make_power_selector(lights)), is_infinite_(lights.size(), false) {
    std::vector<LightTree::Entry> entries;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Light& light = *lights[i];
      const uint8_t list = receivers.empty() ? uint8_t{0} : receivers[i];
      const ListBits bits = list == 0 ? kAllLists : ListBits{1} << list;
      if (const auto bounds = light.bounds()) entries.push_back({i, *bounds, bits});
      if (!light.is_infinite() || !(light.power() > 0.0F)) continue;
      const auto power = static_cast<double>(std::min(light.power(), 1e37F));
      infinite_.push_back({i, power, irradiance_of(light), bits});
      is_infinite_[i] = true;
    }
    has_tree_ = !entries.empty();
    tree_ = LightTree(std::move(entries), lights.size());
  }

  bool empty() const override { return emitters_->empty(); }

  std::optional<SelectedLight> select(const Vec3& from, const Vec3& normal, float u,
                                      ListBits lists) const override {
    return select_by(u, AtPoint{tree_, from, normal, lists});
  }

  float probability(const Vec3& from, const Vec3& normal, uint32_t light,
                    ListBits lists) const override {
    return probability_by(light, AtPoint{tree_, from, normal, lists});
  }

  std::optional<SelectedLight> select_along(const Ray& way, float length, float u,
                                            ListBits lists) const override {
    return select_by(u, AlongWay{tree_, way, length, lists});
  }

  float probability_along(const Ray& way, float length, uint32_t light,
                          ListBits lists) const override {
    return probability_by(light, AlongWay{tree_, way, length, lists});
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
    uint32_t first = 0;     ///< of the tree's, of its root's first child
    uint32_t infinite = 0;  ///< how many infinite lights share the others
    double power = 0.0;     ///< of those together
  };

  /// An infinite light.
  struct Infinite {
    uint32_t index = 0;
    double power = 0.0;
    double irradiance = 0.0;  ///< straight on [W/m^2]
    ListBits receivers = kAllLists;
  };

  template <class Importance>
  Shares shares_at(const Importance& importance) const {
    Shares shares;
    double irradiance = 0.0;
    for (const Infinite& light : infinite_) {
      if ((light.receivers & importance.lists) == 0) continue;
      ++shares.infinite;
      shares.power += light.power;
      irradiance += light.irradiance;
    }
    if (!has_tree_ || !importance.links(tree_.root())) return shares;
    const LightTreeNode& root = tree_.root();
    const bool alone = shares.infinite == 0;
    if (root.is_leaf()) {
      shares.tree = alone ? kAllSteps : steps_of_tree(importance, importance(root), irradiance);
      return shares;
    }
    const LightTreeNode& one = tree_.child(root, false);
    const LightTreeNode& other = tree_.child(root, true);
    const float first = look_into(tree_, one, importance, kLookAhead);
    const float second = look_into(tree_, other, importance, kLookAhead);
    shares.tree = alone ? kAllSteps : steps_of_tree(importance, first + second, irradiance);
    shares.first = share_of_first(shares.tree, first, second, one, other, importance);
    return shares;
  }

  /// Half, and up to a half of that more or less by what lamps and skies may bring to the place.
  /// What stands between is not known: neither may be left to chance.
  static uint32_t steps_of_tree(const AtPoint&, float expected, double irradiance) {
    const double lamps = expected > 0.0F ? std::min(static_cast<double>(expected), 1e30) : 0.0;
    const double both = lamps + irradiance;
    const double share = both > 0.0 ? lamps / both : 0.5;
    return static_cast<uint32_t>((0.25 + 0.5 * share) * double{kSteps});
  }
  /// Along a way the tree tells of no irradiance.
  static uint32_t steps_of_tree(const AlongWay&, float, double) { return kAllSteps / 2; }

  /// Calls visit(light, begin, end) for the runs of `steps` that the infinite lights of `lists`
  /// share, one step at least for each, until it returns true.
  template <class Visit>
  void for_runs(const Shares& shares, ListBits lists, const Visit& visit) const {
    const uint32_t steps = kAllSteps - shares.tree;
    uint32_t begin = 0;
    uint32_t place = 0;
    double up_to = 0.0;
    for (const Infinite& light : infinite_) {
      if ((light.receivers & lists) == 0) continue;
      up_to += light.power;
      ++place;
      const auto rest = static_cast<double>(steps - shares.infinite);
      const uint32_t end = place == shares.infinite
                               ? steps
                               : place + static_cast<uint32_t>(rest * (up_to / shares.power));
      if (visit(light, begin, end)) return;
      begin = end;
    }
  }

  template <class Importance>
  std::optional<SelectedLight> select_by(float u, const Importance& importance) const {
    auto step = static_cast<uint32_t>(std::clamp(u, 0.0F, 0x1.fffffep-1F) * kSteps);
    const Shares shares = shares_at(importance);
    if (step >= shares.tree) {
      step -= shares.tree;
      std::optional<SelectedLight> selected;
      for_runs(shares, importance.lists, [&](const Infinite& light, uint32_t begin, uint32_t end) {
        if (step >= end) return false;
        selected = SelectedLight{light.index, static_cast<float>(end - begin) / kSteps};
        return true;
      });
      return selected;
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
    if (light >= is_infinite_.size()) return 0.0F;
    if (!is_infinite_[light] && !(has_tree_ && tree_.holds(light))) return 0.0F;
    const Shares shares = shares_at(importance);
    if (is_infinite_[light]) {
      float probability = 0.0F;
      for_runs(shares, importance.lists, [&](const Infinite& run, uint32_t begin, uint32_t end) {
        if (run.index != light) return false;
        probability = static_cast<float>(end - begin) / kSteps;
        return true;
      });
      return probability;
    }
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
                          look_into(tree_, other, importance, kLookAhead), one, other, importance);
  }

  std::unique_ptr<LightSelector> emitters_;  ///< for light paths
  LightTree tree_;
  bool has_tree_ = false;
  std::vector<Infinite> infinite_;  ///< those with power
  std::vector<bool> is_infinite_;   ///< by light: whether it is one of them
};

}  // namespace

std::unique_ptr<LightSelector> make_tree_selector(const std::vector<LightPtr>& lights,
                                                  const std::vector<uint8_t>& receivers) {
  return std::make_unique<TreeSelector>(lights, receivers);
}

}  // namespace hyades::core
