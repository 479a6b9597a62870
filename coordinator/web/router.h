#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/operations/operation.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// All routes of the server; finds the one that answers a request.
class Router {
 public:
  /// Called by the network's thread, so it never waits.
  using Handler = std::function<void(const WebRequest&, const Answer&)>;

  /// `pattern`: "/api/v1/jobs/{job}/outputs/{path...}": names in braces stand for a part, one with
  /// dots for all that is left (at least one part). The first route that matches answers.
  void add(const std::string& method, const std::string& pattern, Handler handler);

  /// A route.
  struct Entry {
    std::string method;
    std::string pattern;
    std::vector<std::string> parts;  ///< of the pattern, between its slashes
    Handler handler;
    const Operation* operation;  ///< what it asks for
    uint64_t most_bytes;         ///< of a request's body
  };
  /// The route that answers; null where none does.
  const Entry* find(const WebRequest& request) const;
  /// Has the route's handler answer, with request.parameters set. Answers 404 itself where there is
  /// none, and 405 where there is one for other methods only.
  void answer(WebRequest request, const Answer& answer) const;
  const std::vector<Entry>& routes() const { return routes_; }

 private:
  std::vector<Entry> routes_;
};

}  // namespace hyades::coordinator
