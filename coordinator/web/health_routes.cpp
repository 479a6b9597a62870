#include "coordinator/web/route_helpers.h"
#include "coordinator/web/routes.h"

namespace hyades::coordinator {

void add_health_routes(Router& router, Controller& controller, Executors& executors) {
  router.add("GET", "/healthz", [](const WebRequest&, const Answer& answer) {
    answer(text_reply("well\n", "text/plain; charset=utf-8"));
  });
  router.add("GET", "/readyz", [&](const WebRequest& request, const Answer& answer) {
    answer_by(executors, "GET /readyz", request.caller, answer, [&controller] {
      const grpc::Status room = controller.disk().admit(0);
      WebReply reply = text_reply(room.ok() ? "ready\n" : room.error_message() + "\n",
                                  "text/plain; charset=utf-8");
      if (!room.ok()) reply.status = 503;
      return reply;
    });
  });
}

}  // namespace hyades::coordinator
