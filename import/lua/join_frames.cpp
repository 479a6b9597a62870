#include "import/lua/join_frames.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/job/key_index.h"
#include "core/job/read_values.h"
#include "core/job/yaml_build.h"

namespace hyades::core::lua {

namespace {

using Kind = YamlNode::Kind;
using Nodes = std::vector<const YamlPtr*>;  ///< of one path, by frame

/// What takes about as much memory as one value: bytes of a text, items that are pointed to.
constexpr uint64_t kBytesPerValue = 128;
constexpr uint64_t kItemsPerValue = 4;

bool is_number(const YamlNode& node) {
  double number = 0.0;
  return node.kind == Kind::scalar && !node.quoted && parse_number(node.scalar, number);
}

bool is_scalar(const YamlPtr& node) { return node->kind == Kind::scalar; }

/// Numbers and vectors, which can change from frame to frame.
bool is_numeric(const YamlNode& node) {
  if (node.kind != Kind::list) return is_number(node);
  return !node.list.empty() && std::all_of(node.list.begin(), node.list.end(),
                                           [](const YamlPtr& item) { return is_number(*item); });
}

bool is_value(const YamlNode& node) {
  const bool color = node.kind == Kind::scalar && looks_like_color(node.scalar);
  return color || is_numeric(node);
}

class Joiner {
 public:
  explicit Joiner(const std::vector<FrameTree>& trees) : trees_(trees) {}

  YamlPtr joined(const Nodes& nodes) {
    const YamlNode& first = **nodes.front();
    const bool shared = std::all_of(nodes.begin(), nodes.end(),
                                    [&](const YamlPtr* node) { return *node == *nodes.front(); });
    if (shared) return *nodes.front();
    const auto all = [&](const auto& holds) {
      return std::all_of(nodes.begin(), nodes.end(),
                         [&](const YamlPtr* node) { return holds(**node); });
    };
    if (all([&](const YamlNode& n) { return n.kind == Kind::map; })) return maps(nodes);
    const bool lists = all([&](const YamlNode& n) {
      return n.kind == Kind::list && n.list.size() == first.list.size();
    });
    if (lists && !std::all_of(first.list.begin(), first.list.end(), is_scalar)) {
      return list(nodes);
    }
    const bool same = all([&](const YamlNode& n) { return equal(n, first); });
    if (same) return *nodes.front();
    if (all([](const YamlNode& n) { return is_value(n); })) return keyed(nodes);
    return refuse(nodes);
  }

  const Error& error() const { return error_; }

 private:
  /// Of scalars and lists of them.
  static bool equal(const YamlNode& a, const YamlNode& b) {
    return a.kind == b.kind && a.scalar == b.scalar && a.quoted == b.quoted &&
           std::equal(a.list.begin(), a.list.end(), b.list.begin(), b.list.end(),
                      [](const YamlPtr& x, const YamlPtr& y) { return equal(*x, *y); }) &&
           a.map.empty() && b.map.empty();
  }

  YamlPtr list(const Nodes& nodes) {
    auto result = std::make_shared<YamlNode>(**nodes.front());
    const size_t cut = path_.size();
    for (size_t i = 0; i < result->list.size(); ++i) {
      path_ += fmt::format("[{}]", i + 1);
      Nodes items;
      for (const YamlPtr* node : nodes) items.push_back(&(*node)->list[i]);
      result->list[i] = joined(items);
      if (result->list[i] == nullptr) return nullptr;
      path_.resize(cut);
    }
    return result;
  }

  /// Their keys are sorted, so that equal ones stand at equal places.
  YamlPtr maps(const Nodes& nodes) {
    auto result = std::make_shared<YamlNode>(**nodes.front());
    const size_t cut = path_.size();
    for (size_t f = 1; f < nodes.size(); ++f) {
      if (!check_keys(**nodes.front(), **nodes[f], trees_[f].frame)) return nullptr;
    }
    for (size_t i = 0; i < result->map.size(); ++i) {
      path_ += (path_.empty() ? "" : ".") + result->map[i].key;
      Nodes items;
      for (const YamlPtr* node : nodes) items.push_back(&(*node)->map[i].value);
      result->map[i].value = joined(items);
      if (result->map[i].value == nullptr) return nullptr;
      path_.resize(cut);
    }
    return result;
  }

  bool check_keys(const YamlNode& a, const YamlNode& b, int32_t frame) {
    const auto missing = [](const YamlNode& from, const YamlNode& in) -> const YamlEntry* {
      const KeyIndex keys(in);
      for (const YamlEntry& entry : from.map) {
        if (!keys.contains(entry.key)) return &entry;
      }
      return nullptr;
    };
    const auto same_key = [](const YamlEntry& x, const YamlEntry& y) { return x.key == y.key; };
    if (std::equal(a.map.begin(), a.map.end(), b.map.begin(), b.map.end(), same_key)) return true;
    const YamlEntry* const lost = missing(a, b);
    const YamlEntry* const found = lost != nullptr ? lost : missing(b, a);
    const int32_t with = lost != nullptr ? trees_.front().frame : frame;
    const int32_t without = lost != nullptr ? frame : trees_.front().frame;
    complain(found->value->where, (path_.empty() ? "" : path_ + ".") + found->key,
             fmt::format("is there in frame {} and not in frame {}, expected the same things in "
                         "every frame: let what is not to be seen be elsewhere",
                         with, without));
    return false;
  }

  YamlPtr keyed(const Nodes& nodes) const {
    YamlMap keys;
    bool numbers = true;
    for (size_t f = 0; f < nodes.size(); ++f) {
      keys.put(std::to_string(trees_[f].frame), *nodes[f]);
      numbers =
          numbers && is_numeric(**nodes[f]) && (*nodes[f])->list.size() == (*nodes[0])->list.size();
    }
    auto node = std::make_shared<YamlNode>(
        *YamlMap{{"keys", keys.node()}, {"ease", yaml_word(numbers ? "linear" : "step")}}.node());
    node->where = (*nodes.front())->where;
    return node;
  }

  YamlPtr refuse(const Nodes& nodes) {
    const YamlNode& first = **nodes.front();
    size_t f = 1;
    while (f + 1 < nodes.size() && equal(**nodes[f], first)) ++f;
    complain(
        first.where, path_,
        fmt::format("is {} in frame {} and {} in frame {}, expected the same in every frame: "
                    "only numbers, vectors and colours may change",
                    describe(first), trees_.front().frame, describe(**nodes[f]), trees_[f].frame));
    return nullptr;
  }

  void complain(const YamlPlace& where, const std::string& path, const std::string& what) {
    const std::string line =
        where.line > 0 ? fmt::format("{}:{}: ", *where.file, where.line) : std::string();
    error_ = {line + path + " " + what};
  }

  const std::vector<FrameTree>& trees_;
  std::string path_;
  Error error_;
};

/// Values of the memory that a text takes.
uint64_t values_of(const std::string& text) { return text.size() / kBytesPerValue; }

/// Those below and including a node.
uint64_t values_of(const YamlNode& node) {
  uint64_t values = 1 + values_of(node.scalar);
  for (const YamlPtr& item : node.list) values += values_of(*item);
  for (const YamlEntry& entry : node.map) values += values_of(entry.key) + values_of(*entry.value);
  return values;
}

}  // namespace

YamlPtr share_equal(const YamlPtr& first, const YamlPtr& tree, uint64_t& different) {
  const bool alike = first->kind == tree->kind && first->list.size() == tree->list.size() &&
                     first->map.size() == tree->map.size();
  if (!alike || first->scalar != tree->scalar || first->quoted != tree->quoted) {
    different += values_of(*tree);
    return tree;
  }
  auto copy = std::make_shared<YamlNode>(*tree);
  bool same = true;
  for (size_t i = 0; i < copy->list.size(); ++i) {
    copy->list[i] = share_equal(first->list[i], tree->list[i], different);
    same = same && copy->list[i] == first->list[i];
  }
  for (size_t i = 0; i < copy->map.size(); ++i) {
    if (first->map[i].key != tree->map[i].key) {
      same = false;
      different += 1 + values_of(tree->map[i].key);
    }
    copy->map[i].value = share_equal(first->map[i].value, tree->map[i].value, different);
    same = same && copy->map[i].value == first->map[i].value;
  }
  if (same) return first;
  different += (copy->list.size() + copy->map.size()) / kItemsPerValue;
  return copy;
}

Result<YamlPtr> join_frames(const std::vector<FrameTree>& trees) {
  Nodes roots;
  for (const FrameTree& tree : trees) roots.push_back(&tree.tree);
  Joiner joiner(trees);
  YamlPtr tree = joiner.joined(roots);
  if (tree == nullptr) return joiner.error();
  return tree;
}

}  // namespace hyades::core::lua
