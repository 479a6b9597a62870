#include "core/job/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "core/job/made_lines.h"
#include "core/job/yaml_guard.h"

namespace hyades::core {

namespace {

/// Thrown through yaml-cpp's parser to stop it; never leaves this file.
struct Refusal {
  SourceLocation where;
  std::string message;
};

/// Builds the tree from yaml-cpp's events, so that every limit holds while the text is being read.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const MadeLines& lines, Diagnostics& diagnostics)
      : lines_(lines), diagnostics_(diagnostics) {}

  YamlPtr root() const { return root_; }
  bool seen_content() const { return root_ != nullptr; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    auto node = std::make_shared<YamlNode>();
    node->where = at(mark);
    deliver(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      throw Refusal{at(mark), "this alias stands inside its own anchor"};
    }
    count(found->second->weight, mark);
    place(found->second, at(mark), true);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(tag, mark);
    if (value.size() > kMaxYamlScalar) {
      throw Refusal{at(mark), "a text of " + std::to_string(value.size()) + " bytes; at most " +
                                  std::to_string(kMaxYamlScalar) + " are allowed"};
    }
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; };
    if (std::any_of(value.begin(), value.end(), control)) {
      throw Refusal{at(mark), "a text with a control character in it"};
    }
    auto node = std::make_shared<YamlNode>();
    node->kind = YamlNode::Kind::scalar;
    node->quoted = tag == "!";
    node->where = at(mark);
    node->scalar = value;
    node->weight = weight_of_text(value.size());
    deliver(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::list, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map that is still being filled.
  struct Open {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor = 0;
    bool key_pending = false;  ///< map: the last entry waits for its value
    bool drop_value = false;   ///< map: the value belongs to a duplicate key
    std::string key;
    YamlPlace key_where;
    std::map<std::string, int> keys;  ///< and the lines they stand on; see KeyIndex
  };

  YamlPlace at(const YAML::Mark& mark) const { return lines_.at(mark.line + 1, mark.column + 1); }

  void count(uint64_t weight, const YAML::Mark& mark) {
    nodes_ += weight;
    if (nodes_ > kMaxYamlNodes) {
      throw Refusal{at(mark), "more than " + std::to_string(kMaxYamlNodes) +
                                  " values (aliases counted in full)"};
    }
  }

  void refuse_tag(const std::string& tag, const YAML::Mark& mark) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw Refusal{at(mark), "the tag '" + tag.substr(0, 60) + "'; jobs use no YAML tags"};
  }

  void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor) {
    refuse_tag(tag, mark);
    if (static_cast<int>(stack_.size()) >= kMaxYamlDepth) {
      throw Refusal{at(mark), "nested deeper than " + std::to_string(kMaxYamlDepth) + " levels"};
    }
    count(1, mark);
    Open next;
    next.node = std::make_shared<YamlNode>();
    next.node->kind = kind;
    next.node->where = at(mark);
    next.anchor = anchor;
    stack_.push_back(std::move(next));
  }

  void close() {
    const Open done = std::move(stack_.back());
    stack_.pop_back();
    for (const YamlPtr& child : done.node->list) done.node->weight += child->weight;
    for (const YamlEntry& entry : done.node->map) done.node->weight += entry.value->weight;
    if (done.anchor != 0) anchors_[done.anchor] = done.node;
    place(done.node, done.node->where, false);
  }

  void deliver(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
    nodes_ += node->weight;
    if (nodes_ > kMaxYamlNodes) {
      throw Refusal{node->where, "more than " + std::to_string(kMaxYamlNodes) + " values"};
    }
    const bool is_value = !stack_.empty() && stack_.back().key_pending;
    // An empty value may be marked on a later line; its key is where a person would look.
    if (node->kind == YamlNode::Kind::null && is_value) node->where = stack_.back().key_where;
    if (anchor != 0) anchors_[anchor] = node;
    const YamlPlace where = node->where;
    place(std::move(node), where, false);
  }

  /// Puts a finished node where it belongs: root, list item, key or value.
  void place(YamlPtr node, const YamlPlace& where, bool alias) {
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& top = stack_.back();
    if (top.node->kind == YamlNode::Kind::list) {
      top.node->list.push_back(std::move(node));
      return;
    }
    if (!top.key_pending) {
      take_key(top, *node, where, alias);
      return;
    }
    top.key_pending = false;
    if (!top.drop_value) {
      top.node->map.push_back({std::move(top.key), std::move(top.key_where), std::move(node)});
    }
  }

  /// What is to be complained about where `node` stands as a key; null: nothing.
  static const char* wrong_as_key(const YamlNode& node, bool alias) {
    if (alias) return "an alias as a key; keys are plain text";
    if (node.kind == YamlNode::Kind::null) return "an empty key; keys are plain text";
    if (node.kind != YamlNode::Kind::scalar) return "a list or map as a key; keys are plain text";
    if (node.scalar == "<<" && !node.quoted) {
      return "'<<' is not supported; use `like: name` to copy another entry's keys";
    }
    return nullptr;
  }

  void take_key(Open& top, const YamlNode& node, const YamlPlace& where, bool alias) {
    top.key = node.scalar;
    top.key_where = where;
    top.key_pending = true;
    if (const char* wrong = wrong_as_key(node, alias)) {
      top.drop_value = true;
      diagnostics_.add(where, wrong);
      return;
    }
    const auto [first, fresh] = top.keys.emplace(top.key, where.line);
    top.drop_value = !fresh;
    if (!fresh) {
      diagnostics_.add(where, "duplicate key '" + top.key.substr(0, 60) + "' (first at line " +
                                  std::to_string(first->second) + ")");
    }
  }

  const MadeLines& lines_;
  Diagnostics& diagnostics_;
  YamlPtr root_;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, YamlPtr> anchors_;
  uint64_t nodes_ = 0;
};

}  // namespace

const YamlEntry* YamlNode::find(std::string_view key) const {
  const auto found =
      std::find_if(map.begin(), map.end(), [&](const YamlEntry& e) { return e.key == key; });
  return found == map.end() ? nullptr : &*found;
}

YamlPtr parse_yaml(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  if (!check_yaml_text(text, file, diagnostics)) return nullptr;
  std::istringstream in{std::string(text)};
  const MadeLines lines(text, file);
  TreeBuilder builder(lines, diagnostics);
  try {
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder) || !builder.seen_content()) {
      auto empty = std::make_shared<YamlNode>();
      empty->where = {std::make_shared<const std::string>(file), 1, 1};
      return empty;
    }
    YamlPtr root = builder.root();
    TreeBuilder second(lines, diagnostics);
    if (parser.HandleNextDocument(second)) {
      const SourceLocation top{file, 1, 1};
      diagnostics.add(second.seen_content() ? SourceLocation(second.root()->where) : top,
                      "a second YAML document ('---'); a job is one document");
      return nullptr;
    }
    return root;
  } catch (const Refusal& refusal) {
    diagnostics.add(refusal.where, refusal.message);
  } catch (const YAML::Exception& error) {
    const bool known = !error.mark.is_null();
    diagnostics.add({file, known ? error.mark.line + 1 : 0, known ? error.mark.column + 1 : 0},
                    "not valid YAML: " + error.msg + hint_for_syntax_error(text));
  }
  return nullptr;
}

const YamlNode& empty_map() {
  static const YamlNode node = [] {
    YamlNode map;
    map.kind = YamlNode::Kind::map;
    return map;
  }();
  return node;
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::list:
      return "a list of " + std::to_string(node.list.size());
    case YamlNode::Kind::map:
      return node.map.empty() ? "an empty map" : "a map";
    case YamlNode::Kind::scalar:
      break;
  }
  std::string shown = node.scalar.size() > 60 ? node.scalar.substr(0, 57) + "..." : node.scalar;
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return node.quoted ? "the text \"" + shown + "\"" : "'" + shown + "'";
}

}  // namespace hyades::core
