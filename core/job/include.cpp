#include "core/job/include.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/job/join_trees.h"
#include "core/job/made_lines.h"
#include "core/job/media_file.h"
#include "core/job/scene_objects.h"
#include "core/job/script_include.h"

namespace hyades::core {

namespace {

constexpr size_t kMaxDepth = 16;
constexpr size_t kMaxFiles = 256;
constexpr size_t kMaxBytes = size_t{64} << 20;
constexpr uint64_t kMaxValues = 2 * kMaxYamlNodes;  ///< of all files together

class Loader {
 public:
  Loader(const std::string& file_name, AssetResolver& assets, Diagnostics& diagnostics)
      : main_(std::filesystem::path(file_name)), assets_(assets), diagnostics_(diagnostics) {}

  /// The map of `text`, which is file `reference`, with its includes merged below it. `script`: by
  /// whose word it is read; empty: by the job's.
  YamlPtr load(std::string_view text, const std::string& reference, const std::string& shown,
               const std::string& script) {
    bytes_ += text.size();
    YamlPtr own = parse_yaml(text, shown, diagnostics_);
    if (own == nullptr) return own;
    values_ += own->weight;
    if (own->kind != YamlNode::Kind::map) return own;
    note_word(text, reference, shown, script);
    if (open_.empty()) {
      fps_ = fps_of(*own);
      says_fps_ = frames_key(*own, "fps") != nullptr;
      const YamlNode* range = frames_range(*own);
      if (range != nullptr && range->kind == YamlNode::Kind::scalar) frames_ = range->scalar;
    }
    open_.push_back(reference);
    seen_.insert(reference);
    const YamlEntry* include = own->find("include");
    if (include != nullptr)
      own = join_files(*own, *included_by(*include->value, reference), true, diagnostics_);
    own = with_media_files(own, reference);
    open_.pop_back();
    return own;
  }

  /// The job with what its objects bring of scenes of other tools.
  YamlPtr with_scenes(const YamlPtr& root) {
    if (root == nullptr || root->kind != YamlNode::Kind::map) return root;
    open_ = {main_reference()};
    return with_scene_objects(
        root,
        [&](const SceneDocument& wanted, const YamlNode& name, const std::string& what) {
          const SourceLocation where = name.where;
          const std::string included = tree.origins.file_at(where);
          const std::string from = included.empty() ? main_reference() : included;
          if (seen_.contains(resolve_reference(reference_of(wanted), from))) {
            diagnostics_.add(where, what + ": another object brings this scene under the name '" +
                                        wanted.prefix + "' too, expected names that differ");
            return YamlPtr();
          }
          return load_scene(wanted, name, from, what);
        },
        diagnostics_);
  }

  std::string main_reference() const { return main_.filename().lexically_normal().string(); }

  JobTree tree;

 private:
  /// Notes by whose word `text` is read, which is file `reference`. What parts of a script say is
  /// said by the script, whose folder its files are named from.
  void note_word(std::string_view text, const std::string& reference, const std::string& shown,
                 const std::string& script) {
    std::set<std::string> places = MadeLines(text, shown).other_files();
    if (!open_.empty()) {
      for (const std::string& part : places) tree.origins.included[part] = reference;
    }
    places.insert(shown);
    if (script.empty()) return;
    for (const std::string& place : places) tree.origins.scripts[place] = script;
  }

  /// Everything that the value of one `include:` brings, in order.
  YamlPtr included_by(const YamlNode& value, const std::string& from) {
    JoinedFiles all(empty_map());
    const auto add = [&](const YamlNode& name) {
      if (const YamlPtr file = load_named(name, from)) all.add(*file, false, diagnostics_);
    };
    if (value.kind == YamlNode::Kind::list) {
      for (const YamlPtr& name : value.list) add(*name);
    } else {
      add(value);
    }
    return all.map();
  }

  enum class Opens : uint8_t { file, document };  ///< document: what is made of a scene

  struct Opened {
    std::string reference;
    std::string shown;
    std::string script;  ///< by whose word it is read; empty: by the job's
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
    return open_file(Opens::file, name.scalar, name, from, what);
  }

  /// Opens the file `wanted`, relative to `from`, that `name` means. Nothing where it was read
  /// already, or after a complaint.
  std::optional<Opened> open_file(Opens opens, const std::string& wanted, const YamlNode& name,
                                  const std::string& from, const std::string& what) {
    if (!check_file_name(wanted, name, what)) return std::nullopt;
    const std::string reference = resolve_reference(wanted, from);
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
    // Before it is opened: what a script makes is made then, and kept.
    if (bytes_ > kMaxBytes || values_ > kMaxValues) {
      complain_too_much(name.where);
      return std::nullopt;
    }
    seen_.insert(reference);
    // A file that only has such a name tells nothing of a scene, its marks nothing of a script.
    const bool made = opens == Opens::document;
    const auto scene = made ? document_of(reference) : std::nullopt;
    const std::string named = scene ? scene->scene : reference;
    std::string script = tree.origins.script_at(name.where);
    if (!script.empty()) {
      if (const auto may = assets_.may_name(script, named); !may) {
        diagnostics_.add(name.where, what + ": " + may.error().message);
        return std::nullopt;
      }
    } else if (is_script_file(named)) {
      script = named;
    }
    auto bytes = made ? assets_.open_document(wanted, from) : assets_.open(wanted, from);
    if (!bytes) {
      diagnostics_.add(name.where, what + ": " + bytes.error().message);
      return std::nullopt;
    }
    if (bytes->size() + bytes_ > kMaxBytes) {
      bytes_ += bytes->size();
      complain_too_much(name.where);
      return std::nullopt;
    }
    // Complaints about what importers make are complaints about the scene.
    const std::string shown = (main_.parent_path() / named).lexically_normal().string();
    tree.includes.push_back(reference);
    tree.origins.included[shown] = reference;
    return Opened{reference, shown, std::move(script), std::move(*bytes)};
  }

  bool check_file_name(const std::string& file, const YamlNode& name, const std::string& what) {
    if (file.size() <= kLongestFileName) return true;
    diagnostics_.add(name.where, what + " is a name of " + std::to_string(file.size()) +
                                     " bytes, expected at most " +
                                     std::to_string(kLongestFileName));
    return false;
  }

  void complain_too_much(const YamlPlace& where) {
    diagnostics_.add(where, bytes_ > kMaxBytes ? "the included files have more than " +
                                                     std::to_string(kMaxBytes >> 20) + " MiB in all"
                                               : "the included files have more than " +
                                                     std::to_string(kMaxValues) + " values in all");
  }

  static const YamlNode* frames_key(const YamlNode& root, const char* key) {
    const YamlEntry* frames = root.find("frames");
    const YamlEntry* entry = frames != nullptr ? frames->value->find(key) : nullptr;
    return entry != nullptr ? entry->value.get() : nullptr;
  }

  /// `frames: 1-48`, or the range of `frames: {range: 1-48}`; null where it is not said.
  static const YamlNode* frames_range(const YamlNode& root) {
    const YamlEntry* frames = root.find("frames");
    const bool short_form = frames != nullptr && frames->value->kind == YamlNode::Kind::scalar;
    return short_form ? frames->value.get() : frames_key(root, "range");
  }

  YamlPtr load_named(const YamlNode& name, const std::string& from) {
    if (name.kind == YamlNode::Kind::map) return load_script(name, from);
    if (name.kind == YamlNode::Kind::scalar && is_script_file(name.scalar)) {
      return load_scene(script(name.scalar), name, from, "include");
    }
    if (name.kind == YamlNode::Kind::scalar && is_scene_file(name.scalar)) {
      return load_scene({name.scalar, {}, fps_, {}}, name, from, "include");
    }
    const auto file = open_named(name, from, "include");
    return file ? load_opened(*file) : nullptr;
  }

  /// A script as the job asks for it, without settings.
  SceneDocument script(const std::string& file) const {
    SceneDocument wanted;
    wanted.scene = file;
    wanted.fps = says_fps_ ? fps_ : 0.0F;
    wanted.frames = frames_;
    return wanted;
  }

  /// `{lua: city.lua, set: {seed: 3}}`.
  YamlPtr load_script(const YamlNode& node, const std::string& from) {
    const auto settings = read_script_include(node, diagnostics_);
    if (!settings) return nullptr;
    SceneDocument wanted = script(settings->scene);
    wanted.set = settings->set;
    return load_scene(wanted, *node.find("lua")->value, from, "include");
  }

  /// The document of a scene of another tool, which lies beside the scene.
  YamlPtr load_scene(const SceneDocument& scene, const YamlNode& name, const std::string& from,
                     const std::string& what) {
    const auto file = open_file(Opens::document, reference_of(scene), name, from, what);
    return file ? load_opened(*file) : nullptr;
  }

  YamlPtr load_opened(const Opened& opened) {
    const Opened* file = &opened;
    YamlPtr root =
        load({file->bytes.chars(), file->bytes.size()}, file->reference, file->shown, file->script);
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
    YamlNode others = *media->value;
    std::erase_if(others.map, [](const YamlEntry& entry) { return entry.key == "file"; });
    JoinedSection all(others);
    const auto add = [&](const YamlNode& name) {
      if (!check_file_name(name.scalar, name, "file of media")) return;
      const std::string meant = resolve_reference(name.scalar, reference);
      if (is_scene_file(meant) || document_of(meant)) {
        diagnostics_.add(name.where, "file of media is " + describe(name) +
                                         ", expected a file of media (.json, .yaml)");
        return;
      }
      const auto file = open_named(name, reference, "file of media");
      if (!file) return;
      const std::string_view text(file->bytes.chars(), file->bytes.size());
      bytes_ += text.size();
      note_word(text, file->reference, file->shown, file->script);
      const YamlPtr section = read_media_file(text, file->shown, diagnostics_);
      if (section == nullptr) return;
      values_ += section->weight;
      all.add(*section, false, diagnostics_);
    };
    if (files->value->kind == YamlNode::Kind::list) {
      for (const YamlPtr& name : files->value->list) add(*name);
    } else {
      add(*files->value);
    }
    auto result = std::make_shared<YamlNode>(*own);
    for (YamlEntry& entry : result->map) {
      if (entry.key == "media") entry.value = all.map();
    }
    return result;
  }

  std::filesystem::path main_;
  AssetResolver& assets_;
  Diagnostics& diagnostics_;
  std::vector<std::string> open_;  ///< files being read, from the job inwards
  std::set<std::string> seen_;
  size_t bytes_ = 0;
  uint64_t values_ = 0;
  // Of the job itself:
  float fps_ = SceneDocument().fps;
  bool says_fps_ = false;
  std::string frames_;  ///< empty: it says none
};

}  // namespace

JobTree load_job_tree(const std::string& text, const std::string& file_name, AssetResolver& assets,
                      Diagnostics& diagnostics) {
  Loader loader(file_name, assets, diagnostics);
  const std::string name = loader.main_reference();
  const std::string script = is_script_file(name) ? name : std::string();
  loader.tree.root = loader.with_scenes(loader.load(text, name, file_name, script));
  return std::move(loader.tree);
}

}  // namespace hyades::core
