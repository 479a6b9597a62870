#include "core/job/like.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "core/job/key_index.h"

namespace hyades::core {

namespace {

/// Keys of which an entry has one: writing any of them replaces what `like` would bring of the
/// whole row.
const std::array<std::vector<std::string>, 3> kEither = {{
    {"shape", "mesh", "curves", "instance", "group"},
    {"metal", "eta", "k", "color"},
    {"anisotropic", "roughness_along"},
}};

bool replaced_by_own(const KeyIndex& own, const std::string& key) {
  if (own.contains(key)) return true;
  for (const auto& row : kEither) {
    bool in_row = false;
    bool own_has_one = false;
    for (const std::string& k : row) {
      in_row |= k == key;
      own_has_one |= own.contains(k);
    }
    if (in_row && own_has_one) return true;
  }
  return false;
}

}  // namespace

YamlPtr merged(const YamlNode& own, const YamlNode& other) {
  auto result = std::make_shared<YamlNode>();
  result->kind = YamlNode::Kind::map;
  result->where = own.where;
  result->weight = own.weight + other.weight;
  for (const YamlEntry& entry : own.map) {
    if (entry.key != "like") result->map.push_back(entry);
  }
  const KeyIndex keys(own);
  for (const YamlEntry& entry : other.map) {
    if (!replaced_by_own(keys, entry.key)) result->map.push_back(entry);
  }
  return result;
}

namespace {

class LikeResolver {
 public:
  LikeResolver(ReadContext& context, const YamlNode& named)
      : context_(context), named_(named), index_(named) {
    state_.resize(named.map.size(), State::untouched);
    values_.resize(named.map.size());
  }

  /// Follows the chain of likes from entry `start` with a list instead of recursion: a chain may be
  /// as long as the text allows.
  void resolve(size_t start) {
    std::vector<size_t> chain;
    size_t i = start;
    while (state_[i] == State::untouched) {
      state_[i] = State::open;
      chain.push_back(i);
      const YamlEntry* like = like_of(i);
      if (like == nullptr) break;
      const auto next = target_of(i, *like);
      if (next == kNone) break;
      if (state_[next] == State::open) {
        context_.complain(like->value->where, "'" + named_.map[i].key + "' is like '" +
                                                  like->value->scalar +
                                                  "', which in the end is like itself");
        break;
      }
      i = next;
    }
    for (auto link = chain.rbegin(); link != chain.rend(); ++link) finish(*link);
  }

  YamlPtr value(size_t i) const { return values_[i]; }

 private:
  enum class State : uint8_t { untouched, open, done };
  static constexpr size_t kNone = KeyIndex::kNone;

  const YamlEntry* like_of(size_t i) const {
    const YamlNode& own = *named_.map[i].value;
    return own.kind == YamlNode::Kind::map ? own.find("like") : nullptr;
  }

  size_t target_of(size_t i, const YamlEntry& like) {
    const size_t found = index_.find(like.value->scalar);
    if (like.value->kind == YamlNode::Kind::scalar && found != kNone) return found;
    if (context_.diagnostics.full()) return kNone;
    std::vector<std::string> names;
    for (const YamlEntry& entry : named_.map) {
      if (names.size() < 1000 && entry.key != named_.map[i].key) names.push_back(entry.key);
    }
    context_.complain(like.value->where, "like is " + describe(*like.value) +
                                             ", expected another name of this list" +
                                             did_you_mean(like.value->scalar, names));
    return kNone;
  }

  void finish(size_t i) {
    values_[i] = named_.map[i].value;
    state_[i] = State::done;
    const YamlEntry* like = like_of(i);
    if (like == nullptr) return;
    const size_t found = index_.find(like->value->scalar);
    const bool usable = found != kNone && state_[found] == State::done && found != i &&
                        values_[found]->kind == YamlNode::Kind::map;
    const YamlNode& other = usable ? *values_[found] : empty_map();
    if (context_.spend(other.map.size(), like->value->where)) {
      values_[i] = merged(*named_.map[i].value, other);
    }
  }

  ReadContext& context_;
  const YamlNode& named_;
  KeyIndex index_;
  std::vector<State> state_;
  std::vector<YamlPtr> values_;
};

}  // namespace

std::vector<YamlEntry> resolve_likes(ReadContext& context, const YamlNode& named) {
  LikeResolver resolver(context, named);
  std::vector<YamlEntry> entries = named.map;
  for (size_t i = 0; i < entries.size(); ++i) {
    resolver.resolve(i);
    entries[i].value = resolver.value(i);
  }
  return entries;
}

}  // namespace hyades::core
