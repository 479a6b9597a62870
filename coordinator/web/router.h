#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/access/rules.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Finds out who answers a request.
class Router {
 public:
  /// Called by the network's thread, so it never waits.
  using Handler = std::function<void(const WebRequest&, const Answer&)>;

  /// `pattern`: "/api/v1/jobs/{job}/outputs/{path...}": names in braces stand for a part, one with
  /// dots for all that is left (at least one part). The first route that matches answers.
  void add(const std::string& method, const std::string& pattern, Handler handler);

  struct Route {
    std::string method;
    std::string pattern;
    std::vector<std::string> parts;
    Handler handler;
    const Rule* rule;  ///< who may ask for it
  };
  /// The route that answers; null where none does.
  const Route* find(const WebRequest& request) const;
  /// Calls the handler, with request.parameters set. Not found: 404; found under another method:
  /// 405.
  void answer(WebRequest request, const Answer& answer) const;
  /// Hears of answers to what changes something, before they go out: who asked for what, about
  /// what; called by any thread.
  using Note =
      std::function<void(const Caller&, const Rule&, const std::string& target, const WebReply&)>;
  void set_note(Note note) { note_ = std::move(note); }

  const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
  Note note_;
};

}  // namespace hyades::coordinator
