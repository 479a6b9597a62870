#include "cli/client/upload.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/transfer_display.h"
#include "core/base/hash.h"
#include "core/base/text.h"
#include "farm/wire.h"

namespace hyades::cli {

using core::AssetRecord;

namespace {

constexpr int kMostRestarts = 1;  // of one file whose bytes arrived damaged

/// A file to be sent, and from where on.
struct Missing {
  AssetRecord file;
  uint64_t offset = 0;
};

Outcome ask(FarmClient& client, const std::vector<AssetRecord>& files,
            std::vector<Missing>& missing) {
  for (size_t at = 0; at < files.size(); at += farm::kMostFilesAsked) {
    v1::FindMissingRequest request;
    std::map<std::string, const AssetRecord*> by_digest;
    for (size_t i = at; i < std::min(files.size(), at + farm::kMostFilesAsked); ++i) {
      const auto digest = farm::digest_from_hex(files[i].sha256);
      if (!digest) return Failure{kFailed, digest.error().message};
      v1::JobFile& asked = *request.add_files();
      asked.set_sha256(farm::to_wire(*digest));
      asked.set_size(files[i].size);
      by_digest[asked.sha256()] = &files[i];
    }
    v1::FindMissingResponse response;
    if (auto failure = client.call("Assets/FindMissing", request, response)) return failure;
    for (const auto& one : response.missing()) {
      const auto found = by_digest.extract(one.sha256());
      if (!found) {
        return Failure{kFailed,
                       "the coordinator asks for a file that the job does not have, or twice for "
                       "one"};
      }
      const AssetRecord& file = *found.mapped();
      missing.push_back({file, std::min(one.offset(), file.size)});
    }
  }
  return std::nullopt;
}

Outcome upload_file(FarmClient& client, Missing one, core::JobFiles& from,
                    TransferDisplay& display) {
  int restarts = 0;
  // A coordinator that answers all but this has the client's patience begin anew each time.
  uint64_t furthest = one.offset;
  bool stuck = false;
  auto stuck_since = std::chrono::steady_clock::now();
  while (true) {
    const auto input = from.stream(one.file.reference);
    const Outcome failure =
        client.upload(one.file, *input, one.offset, [&](uint64_t bytes) { display.moved(bytes); });
    if (!failure) return std::nullopt;
    if (failure->from_start && one.offset > 0) {
      one.offset = 0;
      continue;
    }
    // What was there of the file before may have been wrong too: once more from the beginning.
    if (failure->damaged ? ++restarts > kMostRestarts : !failure->again) return failure;
    std::vector<Missing> still;
    if (auto broken = ask(client, {one.file}, still)) return broken;
    if (still.empty()) return std::nullopt;
    one = still.front();
    const auto now = std::chrono::steady_clock::now();
    if (one.offset > furthest) {
      furthest = one.offset;
      stuck = false;
    } else if (!std::exchange(stuck, true)) {
      stuck_since = now;
    } else if (std::chrono::duration<double>(now - stuck_since).count() > client.patience()) {
      return failure;
    }
  }
}

}  // namespace

Outcome upload_missing(FarmClient& client, const farm::JobPackage& package, core::JobFiles& from,
                       bool quiet) {
  std::vector<AssetRecord> files;
  std::set<std::string> seen;
  for (const AssetRecord& file : package.files) {
    if (seen.insert(file.sha256).second) files.push_back(file);
  }
  std::vector<Missing> missing;
  if (auto failure = ask(client, files, missing)) return failure;
  TransferDisplay display("uploading", quiet);
  for (const Missing& one : missing) display.expect(one.file.size - one.offset);
  const uint64_t total = display.transfer().total;
  for (size_t i = 0; i < missing.size(); ++i) {
    display.begin_file(fmt::format("{} of {}", i + 1, missing.size()));
    if (auto failure = upload_file(client, missing[i], from, display)) return failure;
  }
  display.clear();
  if (!quiet && !missing.empty()) {
    std::fprintf(stderr, "uploaded %s, %s\n", core::counted(missing.size(), "file").c_str(),
                 core::format_bytes(total).c_str());
  }
  return std::nullopt;
}

}  // namespace hyades::cli
