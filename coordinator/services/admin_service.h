#pragma once

#include "coordinator/access/authority.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/executors.h"
#include "hyades/v1/admin.grpc.pb.h"

namespace hyades::coordinator {

/// All methods of Admin by bytes (raw.h).
using RawAdmin =
    v1::Admin::WithRawCallbackMethod_WhoAmI<v1::Admin::WithRawCallbackMethod_CreateToken<
        v1::Admin::WithRawCallbackMethod_ListTokens<v1::Admin::WithRawCallbackMethod_RevokeToken<
            v1::Admin::WithRawCallbackMethod_Audit<v1::Admin::Service>>>>>;

/// Who may do what (admin_service.cpp).
class AdminService final : public RawAdmin {
 public:
  AdminService(Authority& authority, const Admission& admission, Executors& executors)
      : authority_(authority), admission_(admission), executors_(executors) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* WhoAmI(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* CreateToken(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* ListTokens(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* RevokeToken(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerWriteReactor<Bytes>* Audit(Context* context, const Bytes* asked) override;

 private:
  Authority& authority_;
  const Admission& admission_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
