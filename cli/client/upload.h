#pragma once

#include "cli/client/farm_client.h"
#include "farm/job_package.h"
#include "import/job_files.h"

namespace hyades::cli {

/// Brings every file of `package`, which was made of `from`, to the coordinator that it has not:
/// the rest of it where a part is there. Shows progress on standard error unless `quiet`.
Outcome upload_missing(FarmClient& client, const farm::JobPackage& package, core::JobFiles& from,
                       bool quiet);

}  // namespace hyades::cli
