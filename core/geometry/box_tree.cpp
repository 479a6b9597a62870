#include "core/geometry/box_tree.h"

#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/chunks.h"

namespace hyades::core {
namespace {

constexpr uint32_t kLeafItems = 4;
constexpr size_t kBins = 16;
/// Deeper down ranges are halved, so that no order of boxes makes a tree deeper than its stack.
constexpr int kCostedLevels = 48;
/// Smaller ranges than this are one thread's work.
constexpr size_t kThreadItems = 8192;

/// What a step to a box costs beside a test of an item.
constexpr float kStepCost = 0.5F;

float half_area(const Bounds& b) {
  const Vec3 d = b.size();
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Range {
  size_t begin;
  size_t end;
  Bounds box;
  size_t size() const { return end - begin; }
};

/// Splits ranges of items, which it moves about in its order.
class Splitter {
 public:
  Splitter(const std::vector<Bounds>& boxes, std::vector<uint32_t>& order)
      : boxes_(boxes), order_(order) {}

  Range range(size_t begin, size_t end) const {
    Range r{begin, end, {}};
    for (size_t i = begin; i < end; ++i) r.box.include(boxes_[order_[i]]);
    return r;
  }

  /// Two parts; nothing where a leaf costs less.
  std::optional<std::pair<Range, Range>> split(const Range& r, int level) const {
    if (r.size() <= 1) return std::nullopt;
    Bounds centers;
    for (size_t i = r.begin; i < r.end; ++i) centers.include(boxes_[order_[i]].center());
    const std::optional<Plane> best = level < kCostedLevels ? best_plane(r, centers) : std::nullopt;
    const auto leaf_cost = static_cast<float>(r.size()) * half_area(r.box);
    if (r.size() <= kLeafItems && (!best || best->cost + kStepCost * half_area(r.box) >= leaf_cost))
      return std::nullopt;
    const size_t middle = best ? partition(r, centers, *best) : halve(r, centers);
    return std::pair(range(r.begin, middle), range(middle, r.end));
  }

 private:
  struct Plane {
    int axis;
    size_t bin;  ///< the last on the lower side
    float cost;  ///< of both sides: half areas times items
  };

  static size_t bin_of(const Bounds& box, const Bounds& centers, int axis) {
    const float width = centers.upper[axis] - centers.lower[axis];
    const float place = (box.center()[axis] - centers.lower[axis]) / width;
    return std::min(static_cast<size_t>(place * static_cast<float>(kBins)), kBins - 1);
  }

  std::optional<Plane> best_plane(const Range& r, const Bounds& centers) const {
    std::optional<Plane> best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centers.upper[axis] > centers.lower[axis])) continue;
      std::array<Bounds, kBins> bins;
      std::array<size_t, kBins> counts{};
      for (size_t i = r.begin; i < r.end; ++i) {
        const Bounds& box = boxes_[order_[i]];
        const size_t bin = bin_of(box, centers, axis);
        bins[bin].include(box);
        ++counts[bin];
      }
      std::array<float, kBins> above{};  // cost of the bins above each
      Bounds sum;
      size_t count = 0;
      for (size_t i = kBins - 1; i > 0; --i) {
        sum.include(bins[i]);
        count += counts[i];
        above[i - 1] = count == 0 ? 0.0F : half_area(sum) * static_cast<float>(count);
      }
      sum = {};
      count = 0;
      for (size_t i = 0; i + 1 < kBins; ++i) {
        sum.include(bins[i]);
        count += counts[i];
        if (count == 0 || count == r.size()) continue;
        const float cost = half_area(sum) * static_cast<float>(count) + above[i];
        if (!best || cost < best->cost) best = Plane{axis, i, cost};
      }
    }
    return best;
  }

  size_t partition(const Range& r, const Bounds& centers, const Plane& plane) const {
    const auto from = order_.begin();
    const auto middle = std::stable_partition(
        from + static_cast<ptrdiff_t>(r.begin), from + static_cast<ptrdiff_t>(r.end),
        [&](uint32_t i) { return bin_of(boxes_[i], centers, plane.axis) <= plane.bin; });
    return static_cast<size_t>(middle - from);
  }

  /// Sorted along the axis on which centres lie farthest apart.
  size_t halve(const Range& r, const Bounds& centers) const {
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t middle = r.begin + r.size() / 2;
    const auto from = order_.begin();
    std::nth_element(from + static_cast<ptrdiff_t>(r.begin), from + static_cast<ptrdiff_t>(middle),
                     from + static_cast<ptrdiff_t>(r.end), [&](uint32_t a, uint32_t b) {
                       const float x = boxes_[a].center()[axis];
                       const float y = boxes_[b].center()[axis];
                       return x != y ? x < y : a < b;
                     });
    return middle;
  }

  const std::vector<Bounds>& boxes_;
  std::vector<uint32_t>& order_;
};

void set_box(BoxTree::Sides& sides, size_t child, const Bounds& box) {
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<size_t>(i);
    sides[0][axis][child] = box.lower[i];
    sides[1][axis][child] = box.upper[i];
  }
}

/// That of no child. Halves of it are no numbers.
constexpr float kFarthest = std::numeric_limits<float>::max();
const Bounds kNoBox{Vec3(kFarthest), Vec3(-kFarthest)};

BoxTree::Node empty_node() {
  BoxTree::Node node{};
  for (size_t child = 0; child < 4; ++child) set_box(node.sides, child, kNoBox);
  return node;
}

/// A subtree that a thread makes, and where its root goes.
struct Task {
  Range range;
  int level;
  size_t node;
  size_t child;
  std::vector<BoxTree::Node> made;
};

/// Makes nodes of a range, the first for all of it; ranges small enough become `tasks`, where there
/// are any to be.
class NodeMaker {
 public:
  NodeMaker(const Splitter& splitter, std::vector<BoxTree::Node>& nodes, std::vector<Task>* tasks)
      : splitter_(splitter), nodes_(nodes), tasks_(tasks) {}

  /// The number of the node made.
  uint32_t make(const Range& whole, int level) {
    const auto number = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back(empty_node());
    std::vector<Range> parts{whole};
    std::vector<bool> done{false};
    int below = level;
    while (parts.size() < 4) {
      const std::optional<size_t> largest = largest_of(parts, done);
      if (!largest) break;
      const auto halves = splitter_.split(parts[*largest], below);
      if (!halves) {
        done[*largest] = true;
        continue;
      }
      ++below;
      parts[*largest] = halves->first;
      parts.push_back(halves->second);
      done.push_back(false);
    }
    for (size_t child = 0; child < parts.size(); ++child) {
      set_box(nodes_[number].sides, child, parts[child].box);
      place(number, child, parts[child], level + 2, done[child]);
    }
    return number;
  }

 private:
  static std::optional<size_t> largest_of(const std::vector<Range>& parts,
                                          const std::vector<bool>& done) {
    std::optional<size_t> largest;
    for (size_t i = 0; i < parts.size(); ++i) {
      if (done[i]) continue;
      if (!largest || half_area(parts[i].box) > half_area(parts[*largest].box)) largest = i;
    }
    return largest;
  }

  void place(size_t number, size_t child, const Range& part, int level, bool leaf) {
    if (leaf || part.size() <= kLeafItems) {
      nodes_[number].first[child] = static_cast<uint32_t>(part.begin);
      nodes_[number].count[child] = static_cast<uint32_t>(part.size());
    } else if (tasks_ != nullptr && part.size() <= kThreadItems) {
      tasks_->push_back({part, level, number, child, {}});
    } else {
      const uint32_t made = make(part, level);
      nodes_[number].first[child] = made;
    }
  }

  const Splitter& splitter_;
  std::vector<BoxTree::Node>& nodes_;
  std::vector<Task>* tasks_;
};

}  // namespace

void BoxTree::build(const std::vector<Bounds>& boxes) {
  nodes_.clear();
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0U);
  const Splitter splitter(boxes, order_);
  const Range all = splitter.range(0, boxes.size());
  bounds_ = all.box;
  if (boxes.empty()) return;
  std::vector<Task> tasks;
  NodeMaker(splitter, nodes_, &tasks).make(all, 0);
  const Status made = parallel_for(tasks.size(), tasks.size() > 1 ? 0 : 1, [&](size_t i) {
    Task& task = tasks[i];
    NodeMaker(splitter, task.made, nullptr).make(task.range, task.level);
  });
  if (!made) throw std::bad_alloc();  // nothing else is thrown there
  size_t total = nodes_.size();
  for (const Task& task : tasks) total += task.made.size();
  nodes_.reserve(total);
  for (Task& task : tasks) {
    const auto offset = static_cast<uint32_t>(nodes_.size());
    nodes_[task.node].first[task.child] = offset;
    for (Node& node : task.made) {
      for (size_t child = 0; child < 4; ++child) {
        if (node.count[child] == 0) node.first[child] += offset;
      }
      nodes_.push_back(node);
    }
    task.made = {};
  }
}

void BoxTree::build(const std::vector<MovingBounds>& boxes) {
  std::vector<Bounds> half_way(boxes.size());
  for_chunks(boxes.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) half_way[i] = boxes[i].at(0.5F);
  });
  build(half_way);
  ends_.resize(nodes_.size());
  if (nodes_.empty()) return;
  const MovingBounds all = fit(0, boxes);
  bounds_ = all.begin;
  bounds_.include(all.end);
}

MovingBounds BoxTree::fit(uint32_t number, const std::vector<MovingBounds>& boxes) {
  MovingBounds all;
  for (size_t child = 0; child < 4; ++child) {
    const Node& node = nodes_[number];
    const uint32_t first = node.first[child];
    MovingBounds box;
    if (node.count[child] > 0) {
      for (uint32_t i = first; i < first + node.count[child]; ++i) {
        box.begin.include(boxes[order_[i]].begin);
        box.end.include(boxes[order_[i]].end);
      }
    } else if (first > number) {
      box = fit(first, boxes);
    } else {
      box = {kNoBox, kNoBox};
      set_box(ends_[number], child, kNoBox);
      continue;
    }
    set_box(nodes_[number].sides, child, box.begin);
    set_box(ends_[number], child, box.end);
    all.begin.include(box.begin);
    all.end.include(box.end);
  }
  return all;
}

}  // namespace hyades::core
