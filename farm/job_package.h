#pragma once

#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::farm {

/// A job as its reader found it behind some resolver.
struct ReadJob {
  core::Job job;
  std::vector<core::AssetRecord> assets;  ///< every file that it names, the document left out:
                                          ///< together with `job` what core::render_key wants
};

/// Reads the job whose YAML is file `document` of `files`. The same files give the same job and
/// render keys behind any resolver. `shown` is what complaints call the document. Errors hold every
/// complaint.
core::Result<ReadJob> read_job(const std::string& document, const std::string& shown,
                               core::AssetResolver& files);

/// A job made ready to travel.
struct JobPackage {
  core::Job job;
  std::string document;                  ///< which of `files` is the YAML
  std::vector<core::AssetRecord> files;  ///< the document, then what the loaders opened, in order
};

/// Reads the job whose YAML is file `document` of `files` and finds every file that any of its
/// frames needs, by letting the job's reader open them through a recording resolver: included
/// files, meshes, textures, skies. Each is hashed, none is decoded, as no format that Hyades reads
/// names further files. `shown` is what complaints call the document.
core::Result<JobPackage> package_job(const std::string& document, const std::string& shown,
                                     core::AssetResolver& files);

}  // namespace hyades::farm
