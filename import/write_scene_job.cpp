#include "import/write_scene_job.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/assets.h"
#include "core/base/atomic_file.h"
#include "core/base/folder_links.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/write_ply.h"
#include "core/job/output_path.h"
#include "core/job/parse.h"
#include "core/job/scene_document.h"
#include "core/job/yaml_build.h"
#include "core/job/yaml_writer.h"
#include "import/importing_resolver.h"
#include "import/job_files.h"
#include "import/names.h"
#include "import/scene_job.h"

namespace hyades::core {

namespace {

using Kind = YamlNode::Kind;

/// Of a scene that moves for longer, the first so many frames are written.
constexpr int kMostFrames = 100'000;
/// Names of files to be made, which take memory before any is.
constexpr size_t kMostMadeFiles = 1'000'000;
constexpr size_t kMostMadeNames = size_t{64} << 20;  ///< bytes

/// A tree with some of its maps replaced: `change` gets each map after those within it, and answers
/// what stands in its place.
YamlPtr changed(const YamlPtr& node, const std::function<YamlPtr(const YamlPtr&)>& change) {
  if (node->kind != Kind::map && node->kind != Kind::list) return node;
  auto copy = std::make_shared<YamlNode>(*node);
  for (YamlPtr& item : copy->list) item = changed(item, change);
  for (YamlEntry& entry : copy->map) entry.value = changed(entry.value, change);
  return copy->kind == Kind::map ? change(copy) : YamlPtr(copy);
}

class Writer {
 public:
  explicit Writer(const WriteSceneJob& request)
      : request_(request),
        folder_(folder_of(request.job)),
        made_(std::filesystem::path(request.job).stem().string() + "_files/"),
        disk_(make_file_resolver(folder_)),
        importing_(*disk_, request.missing,
                   request.follow_links ? SceneLinks() : SceneLinks(folder_)) {}

  /// Leaves nothing of it where it fails.
  Result<WrittenSceneJob> write() {
    auto written = write_all();
    if (written) return written;
    std::error_code ignored;
    for (const std::string& file : saved_) std::filesystem::remove(file, ignored);
    std::filesystem::remove(in_folder(made_), ignored);  // only where it is empty
    return written;
  }

 private:
  Result<WrittenSceneJob> write_all() {
    if (auto free = check_free(request_.job); !free) return free.error();
    // Paths lead through it.
    if (auto made = make_folder(folder_); !made) return made.error();
    auto job = read();
    if (!job) return job.error();
    written_.notes = std::move(job->notes);
    source_ = job->source;
    find_frames(*job->tree);
    find_made(*job->tree);
    if (is_too_much()) {
      return Error{fmt::format(
          "{}: it names more than {} files that are made of it, or files whose names have more "
          "than {} MiB",
          request_.scene, kMostMadeFiles, kMostMadeNames >> 20)};
    }
    for (const auto& [name, in_scene] : wanted_) {
      if (auto done = copy(name, in_scene); !done) return done.error();
    }
    if (auto good = check_script(*job->tree); !good) return good.error();
    const YamlPtr tree = changed(job->tree, [&](const YamlPtr& map) { return mesh_as_ply(map); });
    if (!status_) return status_.error();
    const std::string text = heading(job->added) + write_yaml(*tree);
    if (auto good = check(text); !good) return good.error();
    if (auto done = save(request_.job, text); !done) return done.error();
    return std::move(written_);
  }

  Result<SceneJob> read() {
    SceneJobRequest how;
    how.scene = reference_from(request_.scene, folder_);
    how.media = reference_from(request_.media, folder_);
    how.media_in_job = how.media;
    how.how.fps = is_script_file(request_.scene) ? 0.0F : request_.fps;
    how.how.set = request_.set;
    how.how.animation = request_.animation;
    how.how.loop = request_.loop;
    how.how.made = made_;
    // "../scenes/"; nothing where the job lies beside the scene.
    std::string& beside = how.how.beside;
    beside = reference_from(request_.scene, folder_);
    beside.resize(beside.rfind('/') == std::string::npos ? 0 : beside.rfind('/') + 1);
    auto job = scene_job(importing_.sources(), how);
    if (!job) return job;
    const auto inside = importing_.check_files(how.scene, job->files);
    if (!inside) return inside.error();
    return job;
  }

  /// What a script says is its word, which goes for files of its folder only. That of the job which
  /// is written goes for all files.
  Status check_script(const YamlNode& tree) {
    if (!is_script_file(request_.scene)) return {};
    SceneDocument document;
    document.scene = std::filesystem::path(request_.scene).filename().string();
    document.fps = 0.0F;
    importing_.add(reference_of(document), write_yaml_of_script(tree, document.scene));
    Diagnostics diagnostics;
    const YamlPtr job =
        YamlMap{{"hyades", yaml_word("1")}, {"include", yaml_word(document.scene)}}.node();
    (void)parse_job(write_yaml(*job), request_.scene, importing_, diagnostics);
    return refuse_what_would_not_render(diagnostics);
  }

  /// Whether the job can be rendered: a scene may ask for what no job allows, or for a picture that
  /// is not there.
  Status check(const std::string& text) {
    Diagnostics diagnostics;
    (void)parse_job(text, std::filesystem::path(request_.job).filename().string(), importing_,
                    diagnostics);
    return refuse_what_would_not_render(diagnostics);
  }

  static Status refuse_what_would_not_render(const Diagnostics& diagnostics) {
    if (diagnostics.empty()) return {};
    return Error{"the job was not written, for it would not render:\n" + diagnostics.to_string()};
  }

  /// Comments for who reads the job: where it is from, what is not of the scene, what is left out.
  std::string heading(const std::vector<std::string>& added) const {
    const std::string scene = std::filesystem::path(request_.scene).filename().string();
    std::string text = comment(scene + ", as 'hyades import' tells it.");
    if (!added.empty()) text += comment("Not of the scene, which has none: " + listed(added));
    constexpr size_t kMostNotes = 40;
    const std::vector<std::string>& notes = written_.notes;
    for (size_t i = 0; i < std::min(notes.size(), kMostNotes); ++i) text += comment(notes[i]);
    if (notes.size() > kMostNotes) {
      text += comment("and " + std::to_string(notes.size() - kMostNotes) + " more such notes");
    }
    return text;
  }

  static std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
  }

  /// A line of a comment, whatever characters a scene's names have.
  static std::string comment(std::string line) {
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
    return "# " + line + "\n";
  }

  /// Frames of meshes that change: those of the job, and the one after, which the shutter needs.
  void find_frames(const YamlNode& job) {
    const YamlEntry* frames = job.find("frames");
    const YamlEntry* range = frames != nullptr ? frames->value->find("range") : nullptr;
    int first = 1;
    int last = 1;
    if (range != nullptr && std::sscanf(range->value->scalar.c_str(), "%d-%d", &first, &last) < 2) {
      last = first;
    }
    for (int frame = first; frame <= std::min(last, first + kMostFrames) + 1; ++frame) {
      frames_.push_back(frame);
    }
  }

  /// An object whose mesh is a part of an OBJ file, its triangles written by themselves.
  YamlPtr mesh_as_ply(const YamlPtr& map) {
    const YamlEntry* mesh = map->find("mesh");
    if (mesh == nullptr || mesh->value->kind != Kind::scalar || !status_) return map;
    const std::string file = mesh->value->scalar;
    if (file_extension(file) != ".obj") return map;
    const YamlEntry* part = map->find("part");
    const auto name = ply_of(file, part != nullptr ? part->value->scalar : std::string());
    if (!name) {
      status_ = name.error();
      return map;
    }
    YamlMap object;
    for (const YamlEntry& entry : map->map) {
      if (entry.key == "part") continue;
      object.put(entry.key, entry.key == "mesh" ? yaml_text(*name) : entry.value);
    }
    return object.node();
  }

  /// Writes one part of an OBJ file (all of it where `part` is empty) once; the name of its PLY.
  Result<std::string> ply_of(const std::string& file, const std::string& part) {
    const auto known = plys_.find({file, part});
    if (known != plys_.end()) return known->second;
    if (!parts_.contains(file)) {
      auto read = read_mesh_parts(*disk_, file);
      if (!read) return read.error();
      parts_.emplace(file, std::move(*read));
    }
    for (const MeshPart& one : parts_.at(file).parts) {
      if (!part.empty() && one.name != part) continue;
      const std::string stem = part.empty() ? std::filesystem::path(file).stem().string() : part;
      const std::string name = made_ + names_.add(safe_name(stem, "mesh")) + ".ply";
      const Bytes bytes = ply_bytes(*one.mesh);
      if (auto done = save(in_folder(name), {bytes.chars(), bytes.size()}); !done) {
        return done.error();
      }
      return plys_[{file, part}] = name;
    }
    return Error{file + ": there is no part '" + part + "' in it"};
  }

  bool is_too_much() const {
    return wanted_.size() > kMostMadeFiles || wanted_bytes_ > kMostMadeNames;
  }

  void want(const std::string& in_scene) {
    if (wanted_.emplace(made_ + in_scene, in_scene).second) wanted_bytes_ += in_scene.size();
  }

  /// Every file in the folder of what is made that the job names.
  void find_made(const YamlNode& node) {
    // No file has a longer name: check() tells where one is wanted.
    const bool may_be_file = node.kind == Kind::scalar && node.scalar.size() <= kLongestFileName;
    if (may_be_file && node.scalar.starts_with(made_)) {
      const std::string inside = node.scalar.substr(made_.size());
      if (inside.find('#') == std::string::npos) {
        want(inside);
      } else {
        for (const int32_t frame : frames_) {
          if (is_too_much()) break;
          want(output_path(inside, frame));
        }
      }
    }
    for (const YamlPtr& item : node.list) find_made(*item);
    for (const YamlEntry& entry : node.map) find_made(*entry.value);
  }

  Status copy(const std::string& name, const std::string& in_scene) {
    if (saved_.contains(in_folder(name))) return {};
    auto bytes = source_->made_file(in_scene);
    if (!bytes) return bytes.error().in(request_.scene);
    return save(in_folder(name), {bytes->chars(), bytes->size()});
  }

  std::string in_folder(const std::string& name) const {
    return (std::filesystem::path(folder_) / name).string();
  }

  Status check_free(const std::string& path) const {
    std::error_code ignored;
    if (request_.overwrite || !std::filesystem::exists(path, ignored)) return {};
    return Error{path + ": is there already; expected a new name, or --overwrite"};
  }

  static Status make_folder(const std::string& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (!failed) return {};
    return Error{folder + ": the folder could not be made: " + failed.message()};
  }

  Status save(const std::string& path, std::string_view text) {
    if (auto free = check_free(path); !free) return free;
    if (auto stays = stays_in_folder(folder_, path); !stays) return stays;
    if (auto made = make_folder(folder_of(path)); !made) return made;
    auto done = write_file(path, std::as_bytes(std::span(text.data(), text.size())));
    if (!done) return done;
    saved_.insert(path);
    written_.files.push_back(path);
    return {};
  }

  const WriteSceneJob& request_;
  std::string folder_;  ///< of the job
  std::string made_;    ///< folder of what is made, from there on
  std::unique_ptr<AssetResolver> disk_;
  ImportingResolver importing_;
  std::shared_ptr<const SceneSource> source_;
  std::vector<int32_t> frames_;
  Status status_;
  Names names_{"mesh"};
  std::map<std::string, MeshParts> parts_;
  std::map<std::pair<std::string, std::string>, std::string> plys_;
  std::map<std::string, std::string> wanted_;  ///< name in the job's folder -> in the scene's
  size_t wanted_bytes_ = 0;                    ///< of the names in the scene's
  std::set<std::string> saved_;
  WrittenSceneJob written_;
};

}  // namespace

Result<WrittenSceneJob> write_scene_job(const WriteSceneJob& request) {
  return Writer(request).write();
}

}  // namespace hyades::core
