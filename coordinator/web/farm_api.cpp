#include "coordinator/web/farm_api.h"

#include "coordinator/web/metrics.h"
#include "coordinator/web/route_helpers.h"

namespace hyades::coordinator {

void FarmApi::add_routes(Router& router) {
  router.add("GET", "/healthz", [](const WebRequest&, const Answer& answer) {
    answer(text_reply("well\n", "text/plain; charset=utf-8"));
  });
  router.add("GET", "/readyz", [this](const WebRequest&, const Answer& answer) {
    answer_by(executors_.files, answer, [this] {
      const grpc::Status room = controller_.disk().admit(0);
      WebReply reply = text_reply(room.ok() ? "ready\n" : room.error_message() + "\n",
                                  "text/plain; charset=utf-8");
      if (!room.ok()) reply.status = 503;
      return reply;
    });
  });
  router.add("GET", "/metrics", [this](const WebRequest&, const Answer& answer) {
    answer_by(executors_.store, answer, [this] {
      return text_reply(metrics_text(controller_), "text/plain; version=0.0.4; charset=utf-8");
    });
  });
}

}  // namespace hyades::coordinator
