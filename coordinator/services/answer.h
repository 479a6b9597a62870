#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "coordinator/services/admission.h"

namespace hyades::coordinator {

/// Answers a call that is admitted with the status that `what` returns.
template <class What>
grpc::ServerUnaryReactor* answer(const Admission& admission, grpc::CallbackServerContext* context,
                                 What what) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  const grpc::Status admitted = admission.check(*context);
  reactor->Finish(admitted.ok() ? what() : admitted);
  return reactor;
}

}  // namespace hyades::coordinator
