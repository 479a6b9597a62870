// Files by content.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/file_transfer.h"
#include "coordinator/operations/operation.h"
#include "hyades/v1/assets.pb.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kMostOfPiece = uint64_t{8} << 20U;

const BodyForm kMissingFile = {{{"sha256", true}, {"size", true}},
                               "files: expected sha256 and size of each"};
const BodyForm kMissingFiles = {{{"files", true, &kMissingFile}},
                                "expected {\"files\": [{\"sha256\": ..., \"size\": ...}, ...]}"};

grpc::Status find_missing(Backend& at, const v1::FindMissingRequest& request,
                          v1::FindMissingResponse& response, const Caller& caller) {
  if (static_cast<size_t>(request.files_size()) > farm::kMostFilesAsked) {
    return {grpc::StatusCode::INVALID_ARGUMENT, "at most 10,000 files at a time"};
  }
  farm::ContentStore& store = at.controller.assets();
  std::set<std::string> seen;
  for (const v1::JobFile& file : request.files()) {
    const auto digest = farm::digest_from_wire(file.sha256());
    if (!digest) return {grpc::StatusCode::INVALID_ARGUMENT, digest.error().message};
    const std::string name = core::to_hex(*digest);
    if (!seen.insert(name).second) continue;
    bool busy = false;
    if (store.contains(name, file.size(), &busy)) {
      store.touch(name);  // a job will need it
      continue;
    }
    if (busy) return still_checked();
    auto* missing = response.add_missing();
    missing->set_sha256(file.sha256());
    missing->set_offset(std::min(store.begun(name, caller.name), file.size()));
  }
  return grpc::Status::OK;
}

}  // namespace

// clang-format off
std::vector<Operation> asset_operations() {
  return {
      {{"file.find", v1::ROLE_SUBMITTER}, "Assets/FindMissing", Runs::in_files, find_missing,
       {{.path = "POST /api/v1/assets/missing", .body = &kMissingFiles}}, farm::kMaxMessageBytes},
      // Of uploads those that begin are noted (begin_upload()).
      {{"file.upload", v1::ROLE_SUBMITTER}, "Assets/Upload", Runs::in_files, {},
       {{.path = "PUT /api/v1/assets/{sha256}", .query = {{"size"}, {"offset"}}, .most_bytes = kMostOfPiece}}},
      // Who holds a file's SHA-256 has had it, or its job.
      {{"file.download", v1::ROLE_VIEWER, true}, "Assets/Download", Runs::in_files},
  };
}
// clang-format on

}  // namespace hyades::coordinator
