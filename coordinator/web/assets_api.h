#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "coordinator/access/audit_log.h"
#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"
#include "core/base/mutex.h"
#include "farm/content_writer.h"
#include "hyades/v1/web.pb.h"

namespace hyades::coordinator {

/// Uploads of files by content, in pieces (openapi.yaml, PUT /assets/{sha256}). Thread-safe.
class AssetsApi {
 public:
  /// `audit`: the audit log; null where none is kept. All three outlive it.
  AssetsApi(Controller& controller, Executors& executors, AuditLog* audit)
      : controller_(controller), executors_(executors), audit_(audit) {}
  void add_routes(Router& router);
  /// Closes files of which no piece has come for a minute; to be called now and then.
  void sweep();

 private:
  class Hold;
  /// Takes a piece of a file; `offset` becomes how many bytes of the file are here then.
  grpc::Status take(const Caller& caller, const v1::PieceRequest& asked, const std::string& piece,
                    uint64_t& offset);

  /// A file of which not all has come. It is kept open between two pieces, as opening it again
  /// reads all that is there of it.
  struct Open {
    std::unique_ptr<farm::ContentWriter> writer;
    std::chrono::steady_clock::time_point used;
  };
  /// An owner's file: each has one, though they have one name.
  struct FileOf {
    std::string owner;
    std::string name;
    auto operator<=>(const FileOf&) const = default;
  };
  std::unique_ptr<farm::ContentWriter> take_open(const FileOf& file);
  void put_back(const FileOf& file, std::unique_ptr<farm::ContentWriter> writer);
  void let_go_of_old() HYADES_REQUIRES(mutex_);

  Controller& controller_;
  Executors& executors_;
  AuditLog* const audit_;
  core::Mutex mutex_;
  std::map<FileOf, Open> open_ HYADES_GUARDED_BY(mutex_);
  std::set<FileOf> busy_ HYADES_GUARDED_BY(mutex_);  ///< those of which a piece is being written
};

}  // namespace hyades::coordinator
