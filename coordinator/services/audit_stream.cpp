#include <cstdint>
#include <optional>
#include <utility>

#include "coordinator/access/authority.h"
#include "coordinator/services/service.h"

namespace hyades::coordinator {
namespace {

/// Sends what the audit log holds from a time on.
class AuditEntries final : public Producer<v1::AuditEntry> {
 public:
  AuditEntries(grpc::CallbackServerContext& context, farm::ThreadPool& pool, AuditLog* log,
               int64_t since_ms)
      : Producer(context, pool), log_(log), since_ms_(since_ms) {}

 private:
  Step next(v1::AuditEntry& entry, grpc::Status& status, bool may_wait) override {
    if (log_ == nullptr) {
      status = {grpc::StatusCode::FAILED_PRECONDITION, "this coordinator keeps no audit log"};
      return Step::end;
    }
    if (!may_wait) return Step::needs_thread;
    if (!reader_) {
      log_->flush();
      reader_ = log_->read();
    }
    while (auto found = reader_->next()) {
      if (found->time_ms() < since_ms_) continue;
      entry = std::move(*found);
      return Step::message;
    }
    return Step::end;
  }

  AuditLog* const log_;
  const int64_t since_ms_;
  std::optional<AuditLog::Reader> reader_;
};

}  // namespace

void add_audit_stream(Service& service) {
  service.add_server_stream<v1::AuditRequest>(
      "Admin/Audit", [&service](Service::Context& context, const Caller& /*caller*/,
                                v1::AuditRequest&& request, grpc::Status&) {
        return new AuditEntries(context, service.pool_of("Admin/Audit"),
                                service.admission().audit(), request.since_ms());
      });
}

}  // namespace hyades::coordinator
