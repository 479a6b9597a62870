#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "core/job/output_path.h"
#include "core/job/scene_document.h"
#include "import/gltf/read_gltf.h"
#include "import/lua/read_script.h"
#include "import/obj/read_obj_scene.h"
#include "import/pbrt/read_pbrt.h"
#include "import/scene_source.h"

namespace hyades::core {

namespace {

using Reader = Result<std::shared_ptr<const SceneSource>> (*)(AssetResolver& files,
                                                              const std::string& reference);

struct Row {
  std::string_view extension;
  Reader read;
};

constexpr std::array<Row, 6> kReaders = {{
    {".glb", read_gltf},
    {".gltf", read_gltf},
    {".pbrt", read_pbrt},
    {".obj", read_obj_scene},
    {".ply", read_obj_scene},
    {".lua", lua::read_script},
}};

}  // namespace

Result<std::shared_ptr<const SceneSource>> read_scene(AssetResolver& files,
                                                      const std::string& reference) {
  const std::string extension = file_extension(reference);
  for (const Row& row : kReaders) {
    if (extension != row.extension) continue;
    const auto bytes = files.open(reference);
    if (!bytes) return bytes.error();
    if (bytes->size() == 0) return Error{reference + ": the file is empty"};
    return row.read(files, reference);
  }
  return Error{reference +
               ": no scene or mesh that is known by its name; expected one that ends in one of " +
               scene_file_ends()};
}

}  // namespace hyades::core
