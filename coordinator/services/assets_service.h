#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/desks.h"
#include "hyades/v1/assets.grpc.pb.h"

namespace hyades::coordinator {

/// All methods of Assets by bytes (raw.h).
using RawAssets =
    v1::Assets::WithRawCallbackMethod_FindMissing<v1::Assets::WithRawCallbackMethod_Upload<
        v1::Assets::WithRawCallbackMethod_Download<v1::Assets::Service>>>;

/// Files by content (assets_service.cpp).
class AssetsService final : public RawAssets {
 public:
  AssetsService(Brain& brain, const Admission& admission, Desks& desks)
      : brain_(brain), store_(brain.assets()), admission_(admission), desks_(desks) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* FindMissing(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerReadReactor<Bytes>* Upload(Context* context, Bytes* said) override;
  grpc::ServerWriteReactor<Bytes>* Download(Context* context, const Bytes* asked) override;

 private:
  Brain& brain_;
  farm::ContentStore& store_;
  const Admission& admission_;
  Desks& desks_;
};

}  // namespace hyades::coordinator
