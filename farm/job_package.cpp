#include "farm/job_package.h"

#include <utility>

#include "core/job/parse.h"

namespace hyades::farm {

using core::Error;
using core::Result;

Result<ReadJob> read_job(const std::string& document, const std::string& shown,
                         core::AssetResolver& files) {
  const auto text = files.open(document);
  if (!text) return text.error();
  core::RecordingResolver recorder(files);
  core::Diagnostics diagnostics;
  ReadJob read;
  read.job = core::parse_job({text->chars(), text->size()}, shown, recorder, diagnostics);
  if (!diagnostics.empty()) return Error{diagnostics.to_string()};
  read.assets = recorder.records();
  return read;
}

Result<JobPackage> package_job(const std::string& document, const std::string& shown,
                               core::AssetResolver& files) {
  JobPackage package;
  package.document = document;
  core::RecordingResolver recorder(files);
  auto read = read_job(document, shown, recorder);
  if (!read) return read.error();
  package.job = std::move(read->job);
  package.files = recorder.records();
  return package;
}

}  // namespace hyades::farm
