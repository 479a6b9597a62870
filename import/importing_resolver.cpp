#include "import/importing_resolver.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/base/mutex.h"
#include "core/job/scene_document.h"
#include "core/job/yaml_writer.h"
#include "import/scene_source.h"
#include "import/stand_in.h"
#include "import/within_folder.h"

namespace hyades::core {

namespace {

using SourcePtr = std::shared_ptr<const SceneSource>;

Bytes owned(std::string text) {
  const auto held = std::make_shared<const std::string>(std::move(text));
  return {held, std::as_bytes(std::span(held->data(), held->size()))};
}

/// A reference into the folder of a scene.
struct Inside {
  std::string scene;  ///< the scene file
  std::string name;   ///< of the file in its folder
};

/// Splits "robot.glb.files/meshes/body.ply" at each folder on the way that is a scene's, from the
/// outermost on.
std::vector<Inside> all_insides_of(const std::string& reference) {
  std::vector<Inside> all;
  const std::string mark = std::string(kMadeFolder) + "/";
  for (size_t at = reference.find(mark); at != std::string::npos;
       at = reference.find(mark, at + 1)) {
    std::string scene = reference.substr(0, at);
    if (is_scene_file(scene)) all.push_back({std::move(scene), reference.substr(at + mark.size())});
  }
  return all;
}

/// In the outermost; nothing where there is none.
std::optional<Inside> inside_of(const std::string& reference) {
  std::vector<Inside> all = all_insides_of(reference);
  return all.empty() ? std::nullopt : std::optional(std::move(all.front()));
}

/// `reference` without its folder.
std::string file_name(const std::string& reference) {
  return std::filesystem::path(reference).filename().string();
}

}  // namespace

/// Files as importers see them, and what stands in for pictures that are not there.
class ImportingResolver::Sources : public AssetResolver {
 public:
  Sources(AssetResolver& files, MissingTextures missing, SceneLinks links)
      : files_(files), missing_(missing), links_(std::move(links)) {}

  Result<Bytes> open(const std::string& reference, const std::string& from) override {
    if (is_scene_file(from)) {
      const auto inside = check(from, resolve_reference(reference, from));
      if (!inside) return inside.error();
    }
    return open_anywhere(reference, from);
  }

  /// Opens what a job names, which may be any file.
  Result<Bytes> open_anywhere(const std::string& reference, const std::string& from) {
    const std::string resolved = resolve_reference(reference, from);
    auto bytes = files_.open(reference, from);
    if (bytes || !names_picture(resolved) || files_.exists(resolved)) return bytes;
    if (missing_ == MissingTextures::refused) {
      return Error{bytes.error().message + "; --missing-textures lets magenta stand in for it"};
    }
    note(resolved + ": no such picture; magenta stands in for it");
    return magenta_picture();
  }

  bool exists(const std::string& reference) override { return files_.exists(reference); }

  /// `file`: as resolve_reference() gives it.
  Status check(const std::string& scene, const std::string& file) const {
    // What is made of another scene is read of that.
    for (const Inside& other : all_insides_of(file)) {
      if (auto inside = links_.check(scene, other.scene); !inside) return inside;
    }
    return links_.check(scene, file);
  }

  Status check(const std::string& scene, const std::vector<std::string>& files) const {
    for (const std::string& file : files) {
      const auto inside = check(scene, resolve_reference(file, scene));
      if (!inside) return inside.error().in(scene);
    }
    return {};
  }

  /// Keeps a line, once.
  void note(const std::string& line) {
    const MutexLock lock(mutex_);
    if (noted_.insert(line).second) notes_.push_back(line);
  }

  std::vector<std::string> notes() const {
    const MutexLock lock(mutex_);
    return notes_;
  }

 private:
  AssetResolver& files_;
  MissingTextures missing_;
  SceneLinks links_;
  mutable Mutex mutex_;
  std::vector<std::string> notes_ HYADES_GUARDED_BY(mutex_);
  std::set<std::string> noted_ HYADES_GUARDED_BY(mutex_);
};

struct ImportingResolver::State {
  AssetResolver& files;
  Sources lenient;
  mutable Mutex mutex;
  /// And documents that were made.
  std::map<std::string, Bytes> added HYADES_GUARDED_BY(mutex);
  std::map<std::string, SourcePtr> sources HYADES_GUARDED_BY(mutex);

  State(AssetResolver& below, MissingTextures missing, SceneLinks links)
      : files(below), lenient(below, missing, std::move(links)) {}

  /// Reads a scene once. Two who ask for the same one at the same time may both read it; one result
  /// stays.
  Result<SourcePtr> source(const std::string& scene) {
    {
      const MutexLock lock(mutex);
      if (const auto found = sources.find(scene); found != sources.end()) return found->second;
    }
    auto read = read_scene(lenient, scene);
    if (!read) return read;
    const MutexLock lock(mutex);
    return sources.emplace(scene, *read).first->second;
  }

  Result<Bytes> document(const SceneDocument& wanted) {
    const auto scene = source(wanted.scene);
    if (!scene) return scene.error();
    SceneRequest request;
    request.prefix = wanted.prefix;
    request.fps = wanted.fps;
    request.animation = wanted.animation;
    request.loop = wanted.loop;
    request.frames = wanted.frames;
    request.set = wanted.set;
    const bool script = is_script_file(wanted.scene);
    if (script) request.made = file_name(wanted.scene) + std::string(kMadeFolder) + "/";
    if (!script) request.beside = "../";
    const auto told = (*scene)->sections(request);
    if (!told) return told.error();
    if (auto inside = lenient.check(wanted.scene, told->files); !inside) return inside.error();
    for (const std::string& line : told->notes) lenient.note(line);
    return owned(script ? write_yaml_of_script(*told->sections, file_name(wanted.scene))
                        : write_yaml(*told->sections));
  }

  std::optional<Bytes> find_added(const std::string& reference) const {
    const MutexLock lock(mutex);
    const auto found = added.find(reference);
    if (found == added.end()) return std::nullopt;
    return found->second;
  }

  /// Whether nothing on the disk has the name of what is made of `scene`, or of `reference` itself.
  Status is_free(const std::string& scene, const std::string& reference) {
    const std::string folder = scene + std::string(kMadeFolder);
    if (!files.exists(folder) && !files.exists(reference)) return {};
    return Error{folder + ": there is a folder of this name; it stands for what is made of " +
                 scene + ". Give the folder another name"};
  }

  Result<Bytes> made(const Inside& inside, const std::string& reference) {
    if (auto free = is_free(inside.scene, reference); !free) return free.error();
    const auto scene = source(inside.scene);
    if (!scene) return scene.error();
    return (*scene)->made_file(inside.name);
  }
};

ImportingResolver::ImportingResolver(AssetResolver& files, MissingTextures missing,
                                     SceneLinks links)
    : state_(new State(files, missing, std::move(links))) {}

ImportingResolver::~ImportingResolver() = default;

Result<Bytes> ImportingResolver::open(const std::string& reference, const std::string& from) {
  const std::string resolved = resolve_reference(reference, from);
  if (auto added = state_->find_added(resolved)) return *added;
  const auto inside = inside_of(resolved);
  if (inside) return state_->made(*inside, resolved);
  return state_->lenient.open_anywhere(reference, from);
}

Result<Bytes> ImportingResolver::open_document(const std::string& reference,
                                               const std::string& from) {
  const std::string resolved = resolve_reference(reference, from);
  const auto wanted = document_of(resolved);
  if (!wanted) return open(reference, from);
  if (auto added = state_->find_added(resolved)) return *added;
  if (auto free = state_->is_free(wanted->scene, resolved); !free) return free.error();
  auto document = state_->document(*wanted);
  if (!document) return document;
  const MutexLock lock(state_->mutex);
  return state_->added.emplace(resolved, *document).first->second;
}

bool ImportingResolver::exists(const std::string& reference) {
  const std::string resolved = resolve_reference(reference);
  if (state_->find_added(resolved)) return true;
  const auto inside = inside_of(resolved);
  if (inside) return state_->made(*inside, resolved).ok();
  return state_->files.exists(reference);
}

Status ImportingResolver::may_name(const std::string& scene, const std::string& file) {
  const std::filesystem::path whole(file);
  const std::string folder = std::filesystem::path(scene).parent_path().string();
  const bool beside = whole.is_absolute() == std::filesystem::path(scene).is_absolute();
  const auto inside =
      within_folder(beside && !folder.empty() ? whole.lexically_relative(folder).string() : file);
  return inside ? state_->lenient.check(scene, file) : inside.error();
}

bool ImportingResolver::is_on_disk(const std::string& reference) const {
  const std::string resolved = resolve_reference(reference);
  if (state_->find_added(resolved)) return false;
  return !inside_of(resolved) && state_->files.exists(reference);
}

void ImportingResolver::add(const std::string& reference, std::string text) {
  const MutexLock lock(state_->mutex);
  state_->added[resolve_reference(reference)] = owned(std::move(text));
}

void ImportingResolver::adopt(const std::string& scene, SourcePtr source) {
  const MutexLock lock(state_->mutex);
  state_->sources[resolve_reference(scene)] = std::move(source);
}

AssetResolver& ImportingResolver::sources() { return state_->lenient; }

Status ImportingResolver::check_files(const std::string& scene,
                                      const std::vector<std::string>& files) const {
  return state_->lenient.check(scene, files);
}

std::vector<std::string> ImportingResolver::notes() const { return state_->lenient.notes(); }

}  // namespace hyades::core
