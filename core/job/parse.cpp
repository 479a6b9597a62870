#include "core/job/parse.h"

#include <filesystem>

#include "core/job/check_job.h"
#include "core/job/include.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

Job parse_job(const std::string& text, const std::string& file_name, AssetResolver& assets,
              Diagnostics& diagnostics) {
  Job job;
  job.file = file_name;
  job.name = valid_name(std::filesystem::path(file_name).stem().string());
  JobTree tree = load_job_tree(text, file_name, assets, diagnostics);
  if (tree.root == nullptr) return job;
  job.includes = tree.includes;
  ReadContext context(job, diagnostics);
  context.origins = tree.origins;
  context.files_missing = !diagnostics.empty();
  MapReader top(context, *tree.root, "", "", "job");
  if (tree.root->kind != YamlNode::Kind::map) return job;
  read_job(top, job);
  check_job(context, assets);
  return job;
}

}  // namespace hyades::core
