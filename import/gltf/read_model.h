#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "import/gltf/model.h"

namespace hyades::core {

/// Reads a .gltf or .glb file and the buffers that it names, and checks that it holds together.
/// Errors name the file and the place in it.
Result<std::shared_ptr<const GltfModel>> read_gltf_model(AssetResolver& files,
                                                         const std::string& reference);

/// Bytes that stand behind a view with `size` of them: a part of a buffer, or what is compressed
/// in one. Defined beside the reading of buffers; errors name the view.
Result<std::vector<GltfView>> read_views(const JsonValue& root, const std::vector<Bytes>& buffers);

/// Accessors; their elements lie within their views. Errors name the accessor.
Result<std::vector<GltfAccessor>> read_accessors(const JsonValue& root,
                                                 const std::vector<GltfView>& views);

/// Nodes, their hierarchy and the scene's order: fills `nodes` and `order`. The counts of what
/// nodes refer to are those of `model`.
Status read_nodes(const JsonValue& root, GltfModel& model);

}  // namespace hyades::core
