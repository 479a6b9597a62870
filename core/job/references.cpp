#include "core/job/references.h"

#include <string_view>
#include <utility>

namespace hyades::core {
namespace {

/// Collects the names of one kind.
class NamesIn : public FieldVisitor<NamesIn> {
 public:
  explicit NamesIn(NameKind kind) : kind_(kind) {}

  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}
  void value(std::string_view /*key*/, const ColorInput& input) { texture("", input.texture); }
  void value(std::string_view /*key*/, const ScalarInput& input) { texture("", input.texture); }
  void name_of(const KeyName& /*key*/, const std::string& name, NameKind kind) {
    if (kind == kind_ && !name.empty()) names_.push_back(name);
  }

  std::vector<std::string> take() { return std::move(names_); }

 private:
  NameKind kind_;
  std::vector<std::string> names_;
};

/// Collects the files.
class FilesIn : public FieldVisitor<FilesIn> {
 public:
  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}
  void name_of(const KeyName& /*key*/, const std::string& /*name*/, NameKind /*kind*/) {}
  void file(const KeyName& /*key*/, const std::string& file) {
    if (!file.empty()) files_.push_back(file);
  }

  std::vector<std::string> take() { return std::move(files_); }

 private:
  std::vector<std::string> files_;
};

template <class Desc>
std::vector<std::string> names(const Desc& desc, NameKind kind) {
  NamesIn visitor(kind);
  Desc::fields(desc, visitor);
  return visitor.take();
}

template <class Desc>
std::vector<std::string> files(const Desc& desc) {
  FilesIn visitor;
  Desc::fields(desc, visitor);
  return visitor.take();
}

}  // namespace

std::vector<std::string> names_in(const MaterialDesc& material, NameKind kind) {
  return names(material, kind);
}
std::vector<std::string> names_in(const TextureDesc& texture, NameKind kind) {
  return names(texture, kind);
}

std::vector<std::string> files_in(const TextureDesc& texture) { return files(texture); }
std::vector<std::string> files_in(const LightDesc& light) { return files(light); }
std::vector<std::string> files_in(const MediumDesc& medium) { return files(medium); }
std::vector<std::string> files_in(const ObjectDesc& object) { return files(object); }

}  // namespace hyades::core
