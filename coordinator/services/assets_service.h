#pragma once

#include "coordinator/services/admission.h"
#include "farm/content_store.h"
#include "hyades/v1/assets.grpc.pb.h"

namespace hyades::coordinator {

/// Files by content (assets_service.cpp).
class AssetsService final : public v1::Assets::CallbackService {
 public:
  AssetsService(farm::ContentStore& store, const Admission& admission)
      : store_(store), admission_(admission) {}

  using Context = grpc::CallbackServerContext;
  grpc::ServerUnaryReactor* FindMissing(Context* context, const v1::FindMissingRequest* request,
                                        v1::FindMissingResponse* response) override;
  grpc::ServerReadReactor<v1::UploadPart>* Upload(Context* context,
                                                  v1::UploadResponse* response) override;
  grpc::ServerWriteReactor<v1::Chunk>* Download(Context* context,
                                                const v1::DownloadRequest* request) override;

 private:
  farm::ContentStore& store_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
