#include "core/finish/display_transform.h"

#ifdef HYADES_OCIO

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace hyades::core {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Linear Rec.709 to CIE XYZ under D65, row by row: of its primaries and white as ITU-R BT.709 has
/// them.
constexpr double kRec709ToXyz[16] = {0.4123907992659595,
                                     0.35758433938387796,
                                     0.1804807884018343,
                                     0,
                                     0.21263900587151036,
                                     0.7151686787677559,
                                     0.07219231536073371,
                                     0,
                                     0.01933081871559185,
                                     0.11919477979462599,
                                     0.9505321522496606,
                                     0,
                                     0,
                                     0,
                                     0,
                                     1};

/// The role by which configurations name ACES2065-1, which others than themselves know too.
constexpr const char* kInterchange = "aces_interchange";

struct Names {
  std::string display;
  std::string view;
  std::string look;
  std::string working_space;
};

Error unknown(const char* key, const std::string& name, const std::vector<std::string>& there) {
  return Error{fmt::format("color.{} is '{}', which the configuration has not; it has {}{}", key,
                           name, there.empty() ? std::string("none") : join_names(there),
                           did_you_mean(name, there))};
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> displays_of(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumDisplays(); ++i) names.emplace_back(config.getDisplay(i));
  return names;
}

std::vector<std::string> views_of(const ocio::Config& config, const std::string& display) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumViews(display.c_str()); ++i) {
    names.emplace_back(config.getView(display.c_str(), i));
  }
  return names;
}

std::vector<std::string> looks_of(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumLooks(); ++i) names.emplace_back(config.getLookNameByIndex(i));
  return names;
}

std::vector<std::string> spaces_of(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumRoles(); ++i) names.emplace_back(config.getRoleName(i));
  for (int i = 0; i < config.getNumColorSpaces(); ++i) {
    names.emplace_back(config.getColorSpaceNameByIndex(i));
  }
  return names;
}

/// The single looks of "+a, -b | c".
std::vector<std::string> parts_of(const std::string& looks) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : looks + ",") {
    if (c == ',' || c == ':' || c == '|') {
      const size_t begin = part.find_first_not_of(" +-");
      if (begin != std::string::npos) {
        parts.push_back(part.substr(begin, part.find_last_not_of(' ') - begin + 1));
      }
      part.clear();
    } else {
      part += c;
    }
  }
  return parts;
}

Result<Names> choose(const ocio::Config& config, const ColorDesc& color) {
  Names names{color.display, color.view, color.look, color.working_space};
  if (names.display.empty()) names.display = config.getDefaultDisplay();
  if (const auto there = displays_of(config); !has(there, names.display)) {
    return unknown("display", names.display, there);
  }
  if (names.view.empty()) names.view = config.getDefaultView(names.display.c_str());
  if (const auto there = views_of(config, names.display); !has(there, names.view)) {
    return unknown("view", names.view, there).in("display '" + names.display + "'");
  }
  const auto looks = looks_of(config);
  for (const std::string& look : parts_of(names.look)) {
    if (!has(looks, look)) return unknown("look", look, looks);
  }
  if (names.working_space.empty()) names.working_space = ocio::ROLE_SCENE_LINEAR;
  if (!config.getColorSpace(names.working_space.c_str())) {
    return unknown("working_space", names.working_space, spaces_of(config));
  }
  return names;
}

/// Linear Rec.709 to the working space, where the configuration says what its numbers mean.
ocio::TransformRcPtr to_working_space(const ocio::Config& config, const Names& names) {
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  if (!config.hasRole(kInterchange)) return group;
  ocio::MatrixTransformRcPtr matrix = ocio::MatrixTransform::Create();
  matrix->setMatrix(kRec709ToXyz);
  group->appendTransform(matrix);
  ocio::BuiltinTransformRcPtr to_aces = ocio::BuiltinTransform::Create();
  to_aces->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
  to_aces->setDirection(ocio::TRANSFORM_DIR_INVERSE);
  group->appendTransform(to_aces);
  ocio::ColorSpaceTransformRcPtr space = ocio::ColorSpaceTransform::Create();
  space->setSrc(kInterchange);
  space->setDst(names.working_space.c_str());
  group->appendTransform(space);
  return group;
}

class OcioTransform final : public DisplayTransform {
 public:
  OcioTransform(Names names, std::vector<ocio::ConstCPUProcessorRcPtr> steps)
      : names_(std::move(names)), steps_(std::move(steps)) {}

  void apply(Image& picture) const override {
    const long channels = picture.channel_count();
    for (const auto& step : steps_) {
      ocio::PackedImageDesc pixels(picture.data.data(), picture.width, picture.height, channels);
      step->apply(pixels);
    }
  }

  std::string name() const override {
    return names_.display + ", " + names_.view + (names_.look.empty() ? "" : ", " + names_.look);
  }

  std::string transfer() const override {
    const std::string name = lower_case(names_.display);
    const auto says = [&](const char* word) { return name.find(word) != std::string::npos; };
    if (says("srgb")) return "srgb";
    return says("709") || says("1886") ? "bt709" : "";
  }

 private:
  Names names_;
  std::vector<ocio::ConstCPUProcessorRcPtr> steps_;
};

Result<std::shared_ptr<const DisplayTransform>> open(const std::string& path,
                                                     const ColorDesc& color) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
  config->validate();
  auto names = choose(*config, color);
  if (!names) return names.error();
  const auto view = ocio::DisplayViewTransform::Create();
  view->setSrc(names->working_space.c_str());
  view->setDisplay(names->display.c_str());
  view->setView(names->view.c_str());
  const auto pipeline = ocio::LegacyViewingPipeline::Create();
  pipeline->setDisplayViewTransform(view);
  if (!names->look.empty()) {
    pipeline->setLooksOverride(names->look.c_str());
    pipeline->setLooksOverrideEnabled(true);
  }
  std::vector<ocio::ConstCPUProcessorRcPtr> steps = {
      config->getProcessor(to_working_space(*config, *names))->getDefaultCPUProcessor(),
      pipeline->getProcessor(config)->getDefaultCPUProcessor()};
  return std::shared_ptr<const DisplayTransform>(
      std::make_shared<OcioTransform>(std::move(*names), std::move(steps)));
}

}  // namespace

Result<std::shared_ptr<const DisplayTransform>> open_display_transform(const std::string& path,
                                                                       const ColorDesc& color) {
  try {
    auto opened = open(path, color);
    return opened ? opened : opened.error().in(color.config);
  } catch (const std::exception& e) {
    return Error{color.config + ": " + e.what()};
  }
}

}  // namespace hyades::core

#else

namespace hyades::core {

Result<std::shared_ptr<const DisplayTransform>> open_display_transform(const std::string&,
                                                                       const ColorDesc& color) {
  return Error{color.config +
               ": this program was built without OpenColorIO; with libopencolorio-dev installed a "
               "build has it"};
}

}  // namespace hyades::core

#endif
