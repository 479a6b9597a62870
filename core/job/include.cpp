#include "core/job/include.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "core/job/media_file.h"

namespace hyades::core {

namespace {

constexpr size_t kMaxDepth = 16;
constexpr size_t kMaxFiles = 256;
constexpr size_t kMaxBytes = size_t{64} << 20;

const std::array<std::string_view, 6> kNamed = {"textures", "materials", "media",
                                                "groups",   "objects",   "lights"};
const std::array<std::string_view, 6> kSections = {"frames",     "film",   "sampling",
                                                   "integrator", "camera", "environment"};

template <class Names>
bool contains(const Names& names, std::string_view key) {
  return std::find(names.begin(), names.end(), key) != names.end();
}

std::string place_of(const YamlPlace& place) {
  const SourceLocation where = place;
  return where.file + ":" + std::to_string(where.line);
}

class Loader {
 public:
  Loader(const std::string& file_name, AssetResolver& assets, Diagnostics& diagnostics)
      : main_(std::filesystem::path(file_name)), assets_(assets), diagnostics_(diagnostics) {}

  /// The map of `text`, which is file `reference`, with its includes merged below it.
  YamlPtr load(std::string_view text, const std::string& reference, const std::string& shown) {
    bytes_ += text.size();
    YamlPtr own = parse_yaml(text, shown, diagnostics_);
    if (own == nullptr || own->kind != YamlNode::Kind::map) return own;
    open_.push_back(reference);
    seen_.insert(reference);
    const YamlEntry* include = own->find("include");
    if (include != nullptr) own = merge_below(*own, included_by(*include->value, reference), true);
    own = with_media_files(own, reference);
    open_.pop_back();
    return own;
  }

  std::string main_reference() const { return main_.filename().lexically_normal().string(); }

  JobTree tree;

 private:
  /// Everything that the value of one `include:` brings, in order.
  YamlPtr included_by(const YamlNode& value, const std::string& from) {
    auto all = std::make_shared<YamlNode>();
    all->kind = YamlNode::Kind::map;
    YamlPtr merged = all;
    const auto add = [&](const YamlNode& name) {
      if (YamlPtr file = load_named(name, from)) merged = merge_below(*merged, file, false);
    };
    if (value.kind == YamlNode::Kind::list) {
      for (const YamlPtr& name : value.list) add(*name);
    } else {
      add(value);
    }
    return merged;
  }

  struct Opened {
    std::string reference;
    std::string shown;
    Bytes bytes;
  };

  /// The file that `name` stands for, as `what` ("include") names it. Nothing where it was read
  /// already, or after a complaint.
  std::optional<Opened> open_named(const YamlNode& name, const std::string& from,
                                   const std::string& what) {
    if (name.kind != YamlNode::Kind::scalar || name.scalar.empty()) {
      diagnostics_.add(name.where,
                       what + " is " + describe(name) + ", expected a file name or a list of them");
      return std::nullopt;
    }
    const std::string reference = resolve_reference(name.scalar, from);
    if (std::find(open_.begin(), open_.end(), reference) != open_.end()) {
      diagnostics_.add(name.where, "'" + name.scalar + "' includes itself in the end");
      return std::nullopt;
    }
    if (seen_.contains(reference)) return std::nullopt;
    if (open_.size() > kMaxDepth || seen_.size() > kMaxFiles) {
      diagnostics_.add(name.where, "too many includes: at most " + std::to_string(kMaxDepth) +
                                       " deep and " + std::to_string(kMaxFiles) + " in all");
      return std::nullopt;
    }
    auto bytes = assets_.open(name.scalar, from);
    if (!bytes) {
      diagnostics_.add(name.where, what + ": " + bytes.error().message);
      return std::nullopt;
    }
    if (bytes->size() + bytes_ > kMaxBytes) {
      diagnostics_.add(name.where, "the included files have more than " +
                                       std::to_string(kMaxBytes >> 20) + " MiB in all");
      return std::nullopt;
    }
    const std::string shown = (main_.parent_path() / reference).lexically_normal().string();
    tree.includes.push_back(reference);
    tree.shown[shown] = reference;
    return Opened{reference, shown, std::move(*bytes)};
  }

  YamlPtr load_named(const YamlNode& name, const std::string& from) {
    const auto file = open_named(name, from, "include");
    if (!file) return nullptr;
    YamlPtr root = load({file->bytes.chars(), file->bytes.size()}, file->reference, file->shown);
    if (root == nullptr) return nullptr;
    if (root->kind != YamlNode::Kind::map) {
      diagnostics_.add(root->where, "the included file holds " + describe(*root) +
                                        ", expected a map of a job's sections");
      return nullptr;
    }
    return root;
  }

  /// `own` with what the files hold that its `media: {file: ...}` names, and without that key. A
  /// map under it is a medium called so.
  YamlPtr with_media_files(const YamlPtr& own, const std::string& reference) {
    const YamlEntry* media = own->find("media");
    if (media == nullptr || media->value->kind != YamlNode::Kind::map) return own;
    const YamlEntry* files = media->value->find("file");
    if (files == nullptr || files->value->kind == YamlNode::Kind::map) return own;
    auto others = std::make_shared<YamlNode>(*media->value);
    std::erase_if(others->map, [](const YamlEntry& entry) { return entry.key == "file"; });
    YamlPtr all = others;
    const auto add = [&](const YamlNode& name) {
      const auto file = open_named(name, reference, "file of media");
      if (!file) return;
      seen_.insert(file->reference);
      bytes_ += file->bytes.size();
      const YamlPtr section =
          read_media_file({file->bytes.chars(), file->bytes.size()}, file->shown, diagnostics_);
      if (section != nullptr) all = join(*all, *section, false);
    };
    if (files->value->kind == YamlNode::Kind::list) {
      for (const YamlPtr& name : files->value->list) add(*name);
    } else {
      add(*files->value);
    }
    auto result = std::make_shared<YamlNode>(*own);
    for (YamlEntry& entry : result->map) {
      if (entry.key == "media") entry.value = all;
    }
    return result;
  }

  /// `upper` with the keys of `lower` added. `overrides`: a key in both is upper's; otherwise they
  /// stand side by side and it is a complaint.
  YamlPtr merge_below(const YamlNode& upper, const YamlPtr& lower, bool overrides) {
    auto result = std::make_shared<YamlNode>(upper);
    for (const YamlEntry& entry : lower->map) {
      if (entry.key == "include") continue;
      const auto own = std::find_if(result->map.begin(), result->map.end(),
                                    [&](const YamlEntry& e) { return e.key == entry.key; });
      if (own == result->map.end()) {
        result->map.push_back(entry);
        continue;
      }
      const bool maps =
          own->value->kind == YamlNode::Kind::map && entry.value->kind == YamlNode::Kind::map;
      if (maps && contains(kNamed, entry.key)) {
        own->value = join(*own->value, *entry.value, false);
      } else if (maps && contains(kSections, entry.key)) {
        own->value = join(*own->value, *entry.value, overrides);
      } else if (!overrides && entry.key != "hyades") {
        complain_twice(*own, entry);
      }
    }
    return result;
  }

  /// One section of two files.
  YamlPtr join(const YamlNode& upper, const YamlNode& lower, bool overrides) {
    auto result = std::make_shared<YamlNode>(upper);
    std::map<std::string_view, size_t> index;
    for (size_t i = 0; i < upper.map.size(); ++i) index[upper.map[i].key] = i;
    for (const YamlEntry& entry : lower.map) {
      const auto own = index.find(entry.key);
      if (own == index.end()) {
        result->map.push_back(entry);
      } else if (!overrides) {
        complain_twice(upper.map[own->second], entry);
      }
    }
    return result;
  }

  void complain_twice(const YamlEntry& first, const YamlEntry& second) {
    diagnostics_.add(second.key_where, "'" + second.key.substr(0, 60) + "' is also at " +
                                           place_of(first.key_where) +
                                           "; expected it in one file only");
  }

  std::filesystem::path main_;
  AssetResolver& assets_;
  Diagnostics& diagnostics_;
  std::vector<std::string> open_;  ///< files being read, from the job inwards
  std::set<std::string> seen_;
  size_t bytes_ = 0;
};

}  // namespace

JobTree load_job_tree(const std::string& text, const std::string& file_name, AssetResolver& assets,
                      Diagnostics& diagnostics) {
  Loader loader(file_name, assets, diagnostics);
  loader.tree.root = loader.load(text, loader.main_reference(), file_name);
  return std::move(loader.tree);
}

}  // namespace hyades::core
