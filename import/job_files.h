#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "import/importing_resolver.h"

namespace hyades::core {

/// How a job's files are opened.
struct JobFileOptions {
  std::string media;  ///< of a scene: a file of media for its materials, as a path; empty: none
  MissingTextures missing = MissingTextures::refused;
  std::string animation;      ///< of a scene: SceneRequest::animation
  bool loop = false;          ///< of a scene: SceneRequest::loop
  bool follow_links = false;  ///< of scenes' folders, wherever they lead
  ScriptSettings set{};       ///< of a script: its parameters
};

/// A job, or a scene that is to be one (is_scene_file()), with the door to all files that it names.
class JobFiles {
 public:
  /// Opens the job or scene at `path`. A scene is read, and becomes the job of scene_job(). Errors:
  /// no such file, a scene that cannot be read, media for what is no scene of another tool,
  /// settings for what is no script.
  static Result<std::unique_ptr<JobFiles>> open(const std::string& path,
                                                const JobFileOptions& options = {});

  /// References are relative to the folder of the job.
  AssetResolver& files() { return *importing_; }

  /// The name of the job's text in files().
  const std::string& document() const { return document_; }

  /// Whether a file is made of a scene, and lies on no disk.
  bool is_made(const std::string& reference) const { return !importing_->is_on_disk(reference); }

  /// What importers left out, and pictures that are missing: one line each.
  std::vector<std::string> notes() const;

  /// The bytes of a file from its beginning, for sending: a file of the disk is read as it goes on,
  /// so that one that shrinks meanwhile ends the reading, not the program. Not good() where there
  /// is none.
  std::unique_ptr<std::istream> stream(const std::string& reference);

 private:
  JobFiles() = default;

  std::string folder_;
  std::string document_;
  std::vector<std::string> notes_;
  std::unique_ptr<AssetResolver> disk_;
  std::unique_ptr<ImportingResolver> importing_;
};

/// What `path` is called from `folder` on.
std::string reference_from(const std::string& path, const std::string& folder);

/// The folder of a path; "." where it names none.
std::string folder_of(const std::string& path);

}  // namespace hyades::core
