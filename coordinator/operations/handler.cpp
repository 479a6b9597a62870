#include "coordinator/operations/handler.h"

#include <memory>

#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/executors.h"

namespace hyades::coordinator {

void Handler::run(Backend& at, Message& request, const Caller& caller, bool reads,
                  const Respond<Message>& respond) const {
  if (later_) return later_(at, request, respond, caller);
  const std::unique_ptr<Message> response(types_.response->New());
  const auto answer = [&] { return now_(at, request, *response, caller); };
  respond(reads ? within_memory(answer) : answer(), *response);
}

}  // namespace hyades::coordinator
