#include "core/job/referenced_files.h"

#include <set>

#include "core/job/references.h"

namespace hyades::core {

namespace {

class FileList {
 public:
  void add(const std::string& file) {
    if (!file.empty() && seen_.insert(file).second) files.push_back(file);
  }
  void add(const std::vector<std::string>& all) {
    for (const std::string& file : all) add(file);
  }
  void add(const std::vector<ObjectDesc>& objects) {
    for (const ObjectDesc& object : objects) add(files_in(object));
  }

  std::vector<std::string> files;

 private:
  std::set<std::string> seen_;
};

}  // namespace

std::vector<std::string> referenced_files(const Job& job) {
  FileList list;
  for (const TextureDesc& texture : job.textures) list.add(files_in(texture));
  for (const MediumDesc& medium : job.media) list.add(files_in(medium));
  for (const GroupDesc& group : job.groups) list.add(group.objects);
  list.add(job.objects);
  for (const LightDesc& light : job.lights) list.add(files_in(light));
  if (job.environment) list.add(job.environment->image);
  return list.files;
}

}  // namespace hyades::core
