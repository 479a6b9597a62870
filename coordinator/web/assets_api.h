#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "coordinator/access/audit_log.h"
#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"
#include "farm/content_writer.h"
#include "hyades/v1/web.pb.h"

namespace hyades::coordinator {

/// Uploads of files by content, in pieces.
class AssetsApi {
 public:
  /// `audit` (where it is kept who did what; null: nowhere) outlives it, as the others do.
  AssetsApi(Controller& controller, Executors& executors, AuditLog* audit)
      : controller_(controller), executors_(executors), audit_(audit) {}
  void add_routes(Router& router);
  /// Lets go of files whose pieces do not come any more; now and then.
  void sweep();

 private:
  WebReply take(const Caller& caller, const v1::PieceRequest& asked, const std::string& piece);
  WebReply append(farm::ContentWriter& writer, uint64_t offset, const std::string& piece);

  /// A file in the making, between two pieces: to open it anew is to read what is there of it.
  struct Open {
    std::unique_ptr<farm::ContentWriter> writer;
    std::chrono::steady_clock::time_point used;
  };
  struct Taken {
    std::unique_ptr<farm::ContentWriter> writer;
    grpc::Status status;
    bool ok() const { return writer != nullptr; }
  };
  Taken take_writer(const Caller& caller, const std::string& name, uint64_t size);
  void put_back(const std::string& name, std::unique_ptr<farm::ContentWriter> writer);
  void let_go_of_old();
  void done_with(const std::string& name);

  Controller& controller_;
  Executors& executors_;
  AuditLog* const audit_;
  std::mutex mutex_;
  std::map<std::string, Open> open_;  ///< by the file's name
  std::set<std::string> busy_;        ///< files of which a piece is being written
};

}  // namespace hyades::coordinator
