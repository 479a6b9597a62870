#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/operations/operation.h"
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

  struct Entry {
    std::string method;
    std::string pattern;
    std::vector<std::string> parts;
    Handler handler;
    const Operation* operation;  ///< what it asks for
    uint64_t most_bytes;         ///< of a request's body
  };
  /// The route that answers; null where none does.
  const Entry* find(const WebRequest& request) const;
  /// Calls the handler, with request.parameters set. Not found: 404; found under another method:
  /// 405.
  void answer(WebRequest request, const Answer& answer) const;
  const std::vector<Entry>& routes() const { return routes_; }

 private:
  std::vector<Entry> routes_;
};

}  // namespace hyades::coordinator
