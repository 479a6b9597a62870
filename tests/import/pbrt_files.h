#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/read_mesh.h"
#include "core/job/yaml_writer.h"
#include "import/pbrt/read_pbrt.h"

namespace hyades::test {

/// Files that only a test has.
class PbrtFiles : public core::AssetResolver {
 public:
  PbrtFiles() = default;
  explicit PbrtFiles(std::string scene) { add("scene.pbrt", std::move(scene)); }

  void add(const std::string& name, std::string text) {
    files_[name] = std::make_shared<const std::string>(std::move(text));
  }

  core::Result<core::Bytes> open(const std::string& reference, const std::string& from) override {
    const auto found = files_.find(core::resolve_reference(reference, from));
    if (found == files_.end()) return core::Error{"cannot open '" + reference + "'"};
    const auto& text = found->second;
    return core::Bytes(text, std::as_bytes(std::span(text->data(), text->size())));
  }

  /// What a scene only names, and nobody reads here, is taken to be there.
  bool exists(const std::string& reference) override { return !reference.starts_with("missing"); }

 private:
  std::map<std::string, std::shared_ptr<const std::string>> files_;
};

inline core::Bytes bytes_of(const std::string& text) {
  auto kept = std::make_shared<const std::string>(text);
  return core::Bytes(kept, std::as_bytes(std::span(kept->data(), kept->size())));
}

/// A scene around what stands after WorldBegin.
inline std::string pbrt_world(const std::string& world) {
  return "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
         "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n" +
         world;
}

/// The scene in the language of jobs, or the error.
struct PbrtJob {
  std::string text;
  std::vector<std::string> notes;
  std::string error;
  std::shared_ptr<const core::SceneSource> source;
};

inline PbrtJob read_pbrt_job(PbrtFiles& files, const core::SceneRequest& request = {}) {
  PbrtJob out;
  auto source = core::read_pbrt(files, "scene.pbrt");
  if (!source) {
    out.error = source.error().message;
    return out;
  }
  out.source = *source;
  auto sections = out.source->sections(request);
  if (!sections) {
    out.error = sections.error().message;
    return out;
  }
  out.text = core::write_yaml(*sections->sections);
  out.notes = sections->notes;
  return out;
}

inline PbrtJob pbrt_job(const std::string& scene) {
  PbrtFiles files(scene);
  return read_pbrt_job(files);
}

/// The mesh that the scene's file `name` holds.
inline std::shared_ptr<core::TriangleMesh> pbrt_mesh(const PbrtJob& job, const std::string& name) {
  auto bytes = job.source->made_file(name);
  if (!bytes) {
    ADD_FAILURE() << bytes.error().message;
    return nullptr;
  }
  PbrtFiles files;
  files.add("made.ply", std::string(bytes->chars(), bytes->size()));
  auto mesh = core::read_mesh(files, "made.ply");
  if (!mesh) {
    ADD_FAILURE() << mesh.error().message;
    return nullptr;
  }
  return *mesh;
}

}  // namespace hyades::test
