#include "core/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace hyades::core {
namespace {

/// Ways are kept in 64 bits, the last of which says that there is one. From here on down lights are
/// halved by number: 2^23 of them need 23 more steps.
constexpr int kDeepestSplit = 40;
constexpr uint64_t kEnd = 1ULL << 63U;

constexpr int kBuckets = 12;

using Entries = std::vector<LightTree::Entry>;

float surface_of(const Bounds& box) {
  const Vec3 s = box.size();
  return 2.0F * (s.x * s.y + s.y * s.z + s.z * s.x);
}

/// Lights along one axis of the box of their middles, in equal steps.
struct Buckets {
  int axis;
  float lower;
  float scale;

  int of(const LightTree::Entry& entry) const {
    const float place = (entry.bounds.box.center()[axis] - lower) * scale;
    return std::clamp(static_cast<int>(place), 0, kBuckets - 1);
  }
};

/// A split into the buckets before `first_right` and the others.
struct Split {
  Buckets buckets;
  int first_right;
};

/// The best split of entries [begin, end). Nothing where all middles are in one place.
std::optional<Split> best_split(const Entries& entries, size_t begin, size_t end) {
  Bounds middles;
  Bounds box;
  for (size_t i = begin; i < end; ++i) {
    middles.include(entries[i].bounds.box.center());
    box.include(entries[i].bounds.box);
  }
  const Vec3 size = box.size();
  std::optional<Split> best;
  double least = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = middles.size()[axis];
    if (!(extent > 0.0F)) continue;
    const Buckets buckets{axis, middles.lower[axis], static_cast<float>(kBuckets) / extent};
    if (!std::isfinite(buckets.scale)) continue;
    std::array<std::optional<LightBounds>, kBuckets> sums;
    for (size_t i = begin; i < end; ++i) {
      auto& sum = sums[static_cast<size_t>(buckets.of(entries[i]))];
      sum = sum ? join(*sum, entries[i].bounds) : entries[i].bounds;
    }
    const auto cost = [](const LightBounds& b) {
      return double{surface_of(b.box)} * double{orientation_measure(b)} * double{b.power};
    };
    std::array<double, kBuckets> right{};  // costs of the buckets from i on
    std::optional<LightBounds> all;
    for (int i = kBuckets - 1; i > 0; --i) {
      const auto& sum = sums[static_cast<size_t>(i)];
      if (sum) all = all ? join(*all, *sum) : *sum;
      right[static_cast<size_t>(i)] = all ? cost(*all) : 0.0;
    }
    // Thin boxes shall be cut across (the regularisation factor of section 4.4).
    const double longest = double{max_component(size)};
    const double factor = longest / std::max(double{size[axis]}, 1e-6 * longest);
    all.reset();
    for (int i = 1; i < kBuckets; ++i) {
      const auto& sum = sums[static_cast<size_t>(i - 1)];
      if (sum) all = all ? join(*all, *sum) : *sum;
      const double total = factor * ((all ? cost(*all) : 0.0) + right[static_cast<size_t>(i)]);
      if (best && !(total < least)) continue;
      least = total;
      best = Split{buckets, i};
    }
  }
  return best;
}

/// Moves lights that are large for the box of all [begin, end) to the front; returns where the
/// others begin. Among small ones a long lamp would be lost: seen from beside it, what is said of
/// all of them together is far too little.
Entries::iterator set_large_apart(Entries::iterator begin, Entries::iterator end) {
  Bounds box;
  for (auto i = begin; i != end; ++i) box.include(i->bounds.box);
  constexpr float kLarge = 0.25F;
  const float least2 = kLarge * kLarge * glm::dot(box.size(), box.size());
  return std::stable_partition(begin, end, [&](const LightTree::Entry& entry) {
    const Vec3 size = entry.bounds.box.size();
    return glm::dot(size, size) > least2;
  });
}

LightTreeNode node_of(const LightBounds& bounds, uint32_t count) {
  LightTreeNode node;
  node.center = bounds.box.center();
  node.half_size = 0.5F * bounds.box.size();
  node.radius2 = glm::dot(node.half_size, node.half_size);
  const Vec3& h = node.half_size;
  const float middle = h.x + h.y + h.z - max_component(h) - min_component(h);
  node.thickness2 = middle * middle;
  node.axis = bounds.normals.axis;
  node.cos_normals = bounds.normals.cosine;
  node.cos_beyond = bounds.cos_beyond;
  node.intensity = bounds.intensity;
  node.lights = count | (bounds.two_sided ? LightTreeNode::kTwoSided : 0U);
  return node;
}

}  // namespace

LightTree::LightTree(std::vector<Entry> entries, size_t lights) {
  if (entries.empty()) return;
  ways_.assign(lights, 0);
  nodes_.reserve(2 * entries.size() - 1);
  nodes_.emplace_back();
  const bool linked = std::any_of(entries.begin(), entries.end(),
                                  [](const Entry& entry) { return entry.receivers != kAllLists; });
  if (linked) receivers_.resize(nodes_.capacity());
  build(0, entries, 0, entries.size(), 0, 0);
}

LightBounds LightTree::build(uint32_t node, std::vector<Entry>& entries, size_t begin, size_t end,
                             uint64_t way, int depth) {
  if (!receivers_.empty()) {
    for (size_t i = begin; i < end; ++i) receivers_[node] |= entries[i].receivers;
  }
  if (end - begin == 1) {
    nodes_[node] = node_of(entries[begin].bounds, 1);
    nodes_[node].child = entries[begin].index;
    ways_[entries[begin].index] = way | kEnd;
    return entries[begin].bounds;
  }
  const auto first = entries.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = entries.begin() + static_cast<std::ptrdiff_t>(end);
  auto middle = depth < kDeepestSplit ? set_large_apart(first, last) : first;
  if (depth < kDeepestSplit && (middle == first || middle == last)) {
    if (const auto split = best_split(entries, begin, end)) {
      middle = std::stable_partition(first, last, [&](const Entry& entry) {
        return split->buckets.of(entry) < split->first_right;
      });
    }
  }
  if (middle == first || middle == last) middle = first + (last - first) / 2;
  const size_t cut = begin + static_cast<size_t>(middle - first);

  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  const LightBounds left = build(children, entries, begin, cut, way, depth + 1);
  const LightBounds right = build(children + 1, entries, cut, end,
                                  way | (1ULL << static_cast<unsigned>(depth)), depth + 1);
  const LightBounds both = join(left, right);
  nodes_[node] = node_of(both, static_cast<uint32_t>(end - begin));
  nodes_[node].child = children;
  return both;
}

}  // namespace hyades::core
