#include "coordinator/services/admin_service.h"

#include <optional>
#include <utility>

#include "coordinator/access/token.h"
#include "coordinator/services/answer.h"
#include "coordinator/services/file_stream.h"
#include "coordinator/services/producer.h"

namespace hyades::coordinator {
namespace {

class AuditEntries final : public Producer<v1::AuditEntry> {
 public:
  AuditEntries(grpc::CallbackServerContext& context, ThreadPool& pool, AuditLog* log,
               int64_t since_ms)
      : Producer(context, pool), log_(log), since_ms_(since_ms) {}

 private:
  Step next(v1::AuditEntry& entry, grpc::Status& status, bool may_wait) override {
    if (log_ == nullptr) {
      status = {grpc::StatusCode::FAILED_PRECONDITION, "this coordinator keeps no audit log"};
      return Step::end;
    }
    if (!may_wait) return Step::hand;
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

grpc::ServerUnaryReactor* AdminService::WhoAmI(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::WhoAmIRequest, v1::WhoAmIResponse>(
      {admission_, "Admin/WhoAmI", context, asked, said},
      [this](const v1::WhoAmIRequest&, v1::WhoAmIResponse& response, const Caller& caller) {
        response.set_role(caller.role);
        response.set_name(caller.name);
        response.set_token_id(caller.token_id);
        response.set_guarded(authority_.guarded());
        response.set_expires_ms(caller.term.expires_ms);
        response.set_warn_ms(caller.term.warn_ms);
        return grpc::Status::OK;
      });
}

grpc::ServerUnaryReactor* AdminService::CreateToken(Context* context, const Bytes* asked,
                                                    Bytes* said) {
  return answer_by<v1::CreateTokenRequest, v1::CreateTokenResponse>(
      executors_.rows, {admission_, "Admin/CreateToken", context, asked, said},
      [this](const v1::CreateTokenRequest& request, v1::CreateTokenResponse& response) {
        StoredToken row;
        const grpc::Status made = authority_.create(
            request.name(), request.role(), request.lifetime_ms(), *response.mutable_secret(), row);
        if (made.ok()) *response.mutable_token() = to_wire(row);
        return made;
      });
}

grpc::ServerUnaryReactor* AdminService::ListTokens(Context* context, const Bytes* asked,
                                                   Bytes* said) {
  return answer<v1::ListTokensRequest, v1::ListTokensResponse>(
      {admission_, "Admin/ListTokens", context, asked, said},
      [this](const v1::ListTokensRequest&, v1::ListTokensResponse& response) {
        for (const StoredToken& token : authority_.tokens()) {
          *response.add_tokens() = to_wire(token);
        }
        return grpc::Status::OK;
      });
}

grpc::ServerUnaryReactor* AdminService::RevokeToken(Context* context, const Bytes* asked,
                                                    Bytes* said) {
  return answer_by<v1::RevokeTokenRequest, v1::RevokeTokenResponse>(
      executors_.rows, {admission_, "Admin/RevokeToken", context, asked, said},
      [this](const v1::RevokeTokenRequest& request, v1::RevokeTokenResponse& response) {
        StoredToken row;
        const grpc::Status done = authority_.revoke(request.id(), row);
        if (done.ok()) *response.mutable_token() = to_wire(row);
        return done;
      });
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* AdminService::Audit(Context* context,
                                                                const Bytes* asked) {
  Caller caller;
  grpc::Status taken = admission_.check(*context, rule_of_method("Admin/Audit"), caller);
  v1::AuditRequest request;
  if (taken.ok()) taken = parse(*asked, farm::kMaxRequestBytes, request);
  if (!taken.ok()) return new Refusal(taken);
  auto* stream =
      new AuditEntries(*context, executors_.files, authority_.audit(), request.since_ms());
  stream->guard(admission_, caller);
  stream->begin();
  return stream;
}

}  // namespace hyades::coordinator
