#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/executors.h"
#include "hyades/v1/assets.grpc.pb.h"

namespace hyades::coordinator {

/// All methods of Assets by bytes (raw.h).
using RawAssets =
    v1::Assets::WithRawCallbackMethod_FindMissing<v1::Assets::WithRawCallbackMethod_Upload<
        v1::Assets::WithRawCallbackMethod_Download<v1::Assets::Service>>>;

/// Files by content (assets_service.cpp).
class AssetsService final : public RawAssets {
 public:
  AssetsService(Controller& controller, const Admission& admission, Executors& executors)
      : controller_(controller),
        store_(controller.assets()),
        admission_(admission),
        executors_(executors) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* FindMissing(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerReadReactor<Bytes>* Upload(Context* context, Bytes* said) override;
  grpc::ServerWriteReactor<Bytes>* Download(Context* context, const Bytes* asked) override;

 private:
  Controller& controller_;
  farm::ContentStore& store_;
  const Admission& admission_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
