#include "import/gltf/read_model.h"

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "import/gltf/container.h"
#include "import/gltf/extensions.h"
#include "import/gltf/uri.h"

namespace hyades::core {

namespace {

GltfAttributes read_attributes(const JsonValue& value, size_t accessors) {
  GltfAttributes out;
  for (const std::string& key : value.keys()) out[key] = value.required_index(key, accessors);
  return out;
}

GltfPrimitive read_primitive(const JsonValue& value, const GltfModel& model, size_t materials) {
  GltfPrimitive out;
  out.place = value.place();
  out.mode = static_cast<int>(value.integer("mode", 0, 6, 4));
  out.indices = value.index("indices", model.accessors.size());
  out.material = value.index("material", materials);
  out.attributes = read_attributes(value.member("attributes"), model.accessors.size());
  for (const JsonValue& target : value.list("targets")) {
    out.targets.push_back(read_attributes(target, model.accessors.size()));
  }
  const JsonValue draco = value.member("extensions").member("KHR_draco_mesh_compression");
  if (draco.exists()) {
    GltfDraco packed;
    packed.view = draco.required_index("bufferView", model.views.size());
    packed.attributes = read_attributes(draco.member("attributes"), size_t{1} << 16);
    out.draco = std::move(packed);
  }
  return out;
}

void read_meshes(const JsonValue& root, GltfModel& model) {
  const size_t materials = root.list("materials").size();
  for (const JsonValue& value : root.list("meshes")) {
    GltfMesh mesh;
    mesh.name = value.text("name");
    for (const JsonValue& primitive : value.list("primitives")) {
      mesh.primitives.push_back(read_primitive(primitive, model, materials));
    }
    mesh.weights = value.numbers("weights");
    model.meshes.push_back(std::move(mesh));
  }
}

void read_images(const JsonValue& root, GltfModel& model, std::string& failure) {
  for (const JsonValue& value : root.list("images")) {
    GltfImage image;
    image.name = value.text("name");
    image.type = value.text("mimeType");
    image.view = value.index("bufferView", model.views.size());
    const std::string uri = value.text("uri");
    if (image.view < 0 && is_data_uri(uri)) {
      if (image.type.empty()) image.type = data_uri_type(uri);
      auto bytes = decode_data_uri(uri);
      if (!bytes && failure.empty()) failure = bytes.error().in(value.place()).message;
      if (bytes) image.bytes = *bytes;
    } else if (image.view < 0 && !uri.empty()) {
      const auto path = decode_file_uri(uri);
      if (!path && failure.empty()) failure = path.error().in(value.place()).message;
      if (path) image.file = *path;
    } else if (image.view < 0) {
      value.complain("has neither a bufferView nor a uri");
    }
    model.images.push_back(std::move(image));
  }
}

void read_skins(const JsonValue& root, GltfModel& model) {
  for (const JsonValue& value : root.list("skins")) {
    GltfSkin skin;
    skin.place = value.place();
    for (const JsonValue& joint : value.list("joints")) {
      skin.joints.push_back(joint.as_index(model.nodes.size()));
    }
    if (skin.joints.empty()) value.complain("has no joints");
    skin.inverse_bind = value.index("inverseBindMatrices", model.accessors.size());
    if (skin.inverse_bind >= 0) {
      const GltfAccessor& matrices = model.accessors[static_cast<size_t>(skin.inverse_bind)];
      if (matrices.components != 16 || matrices.component != GltfComponent::float32 ||
          matrices.count < skin.joints.size()) {
        value.complain(fmt::format("has {} joints, but {} does not hold as many MAT4 of floats",
                                   skin.joints.size(), matrices.place));
      }
    }
    model.skins.push_back(std::move(skin));
  }
}

GltfChannel read_channel(const JsonValue& value, const std::vector<JsonValue>& samplers,
                         const GltfModel& model) {
  GltfChannel out;
  out.place = value.place();
  const JsonValue target = value.member("target");
  out.node = target.index("node", model.nodes.size());
  const std::string path = target.text("path");
  using Path = GltfChannel::Path;
  if (path == "translation") {
    out.path = Path::translation;
  } else if (path == "rotation") {
    out.path = Path::rotation;
  } else if (path == "scale") {
    out.path = Path::scale;
  } else if (path == "weights") {
    out.path = Path::weights;
  } else {
    out.node = -1;  // of an extension; there is a note for those
  }
  const int at = value.required_index("sampler", samplers.size());
  if (at < 0) return out;
  const JsonValue& sampler = samplers[static_cast<size_t>(at)];
  out.input = sampler.required_index("input", model.accessors.size());
  out.output = sampler.required_index("output", model.accessors.size());
  const std::string way = sampler.text("interpolation");
  if (way == "STEP") {
    out.interpolation = GltfChannel::Interpolation::step;
  } else if (way == "CUBICSPLINE") {
    out.interpolation = GltfChannel::Interpolation::cubic;
  } else if (!way.empty() && way != "LINEAR") {
    sampler.complain("has interpolation '" + way + "', expected LINEAR, STEP or CUBICSPLINE");
  }
  return out;
}

void read_animations(const JsonValue& root, GltfModel& model) {
  for (const JsonValue& value : root.list("animations")) {
    GltfAnimation animation;
    animation.name = value.text("name");
    const std::vector<JsonValue> samplers = value.list("samplers");
    for (const JsonValue& channel : value.list("channels")) {
      GltfChannel read = read_channel(channel, samplers, model);
      if (read.node >= 0) animation.channels.push_back(std::move(read));
    }
    model.animations.push_back(std::move(animation));
  }
}

Status read_all(GltfModel& model, const GltfContainer& container, AssetResolver& files,
                const std::string& reference, JsonTrouble& trouble) {
  const JsonValue root = model.root(trouble);
  if (!root.raw()->is_object()) return Error{"it is JSON, but no glTF"};
  const std::string version = root.member("asset").text("version");
  if (!version.starts_with("2.")) {
    return Error{"asset.version is '" + version + "', expected 2.0"};
  }
  if (Status s = check_extensions(root, model.notes); !s) return s;
  const auto buffers = read_buffers(container, root, files, reference);
  if (!buffers) return buffers.error();
  std::set<const char*> counted;
  for (const Bytes& buffer : *buffers) {
    if (counted.insert(buffer.chars()).second) model.buffer_bytes += buffer.size();
  }
  auto views = read_views(root, *buffers);
  if (!views) return views.error();
  model.views = std::move(*views);
  auto accessors = read_accessors(root, model.views);
  if (!accessors) return accessors.error();
  model.accessors = std::move(*accessors);
  if (!trouble.none()) return {};
  read_meshes(root, model);
  std::string failure;
  read_images(root, model, failure);
  if (!failure.empty()) return Error{failure};
  model.nodes.resize(root.list("nodes").size());
  read_skins(root, model);
  if (Status s = read_nodes(root, model); !s) return s;
  read_animations(root, model);
  return {};
}

}  // namespace

Result<std::shared_ptr<const GltfModel>> read_gltf_model(AssetResolver& files,
                                                         const std::string& reference) {
  const auto bytes = files.open(reference);
  if (!bytes) return bytes.error();
  const auto container = open_container(*bytes);
  if (!container) return container.error().in(reference);
  auto model = std::make_shared<GltfModel>();
  model->file = reference;
  model->json = container->json;
  JsonTrouble trouble;
  const Status read = read_all(*model, *container, files, reference, trouble);
  // What was found wrong first is what the rest stumbles over.
  if (!trouble.none()) return model->error(trouble.message);
  if (!read) return model->error(read.error().message);
  return std::shared_ptr<const GltfModel>(std::move(model));
}

}  // namespace hyades::core
