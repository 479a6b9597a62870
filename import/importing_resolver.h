#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "import/scene_links.h"
#include "import/scene_source.h"

namespace hyades::core {

/// What becomes of pictures that a job or scene names and that are not there.
enum class MissingTextures {
  refused,  ///< opening them fails, as with any file
  magenta,  ///< one pixel of magenta stands in for each, and a note says so
};

/// A resolver that also has, beside every scene file F of `files` (is_scene_file()), the folder
/// F.files: the scene as a document of the job language (core/job/scene_document.h), made by
/// open_document(), and the meshes and pictures that the document names, made when they are opened.
/// Each scene is read once. A folder of that name on the disk, beside the scene, would be taken for
/// what is made: opening anything in it is an error that says so. Thread-safe.
class ImportingResolver : public AssetResolver {
 public:
  explicit ImportingResolver(AssetResolver& files,
                             MissingTextures missing = MissingTextures::refused,
                             SceneLinks links = {});
  ~ImportingResolver() override;

  Result<Bytes> open(const std::string& reference, const std::string& from = {}) override;
  Result<Bytes> open_document(const std::string& reference, const std::string& from = {}) override;
  bool exists(const std::string& reference) override;

  /// Files of the scene's folder and below, by links too.
  Status may_name(const std::string& scene, const std::string& file) override;

  /// Whether open() reads a file of the resolver below, and makes nothing.
  bool is_on_disk(const std::string& reference) const;

  /// Takes over a scene that has been read, so that it is not read again.
  void adopt(const std::string& scene, std::shared_ptr<const SceneSource> source);

  /// What importers open their files with: those below, and what stands in for missing pictures.
  /// What a scene names there must lie in its folder, by links too.
  AssetResolver& sources();

  /// Whether all of SceneSections::files of a scene lie there.
  Status check_files(const std::string& scene, const std::vector<std::string>& files) const;

  /// Another file that only this resolver has.
  void add(const std::string& reference, std::string text);

  /// What scenes that were imported said and jobs cannot, and what stands in for missing pictures:
  /// a line each, in order of first opening, each once.
  std::vector<std::string> notes() const;

 private:
  class Sources;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hyades::core
