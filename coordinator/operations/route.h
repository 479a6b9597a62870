#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "coordinator/operations/executors.h"
#include "coordinator/operations/handler.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// A field of the request that the query of an HTTP request may give.
struct QueryField {
  const char* name;
  int64_t least = INT64_MIN;  ///< that it may be, where it is a number
  int64_t most = INT64_MAX;
};

struct BodyForm;
/// A field of the request that the body of an HTTP request gives.
struct BodyField {
  const char* path;                 ///< "spec.name": the JSON's `name` goes there
  bool needed = false;              ///< the request makes no sense without
  const BodyForm* items = nullptr;  ///< of a list of objects
};
/// The JSON object that the body of an HTTP request is.
struct BodyForm {
  std::vector<BodyField> fields;
  /// Said of whatever is not as it should be; unknown fields are passed over then. Null: each
  /// mistake is told by its name.
  const char* expected = nullptr;
  const char* no_object = nullptr;  ///< said where it is none, if mistakes are told by name
  bool may_be_empty = false;        ///< no body is as good as an object without fields
};

/// What an HTTP client gets.
struct HttpForm {
  farm::Json body;  ///< null: there is none
  unsigned status = 200;
};
/// Makes an HttpForm of a response. It is made of HttpForm f(const Request&, const Response&).
class Show {
 public:
  Show() = default;
  template <class Request, class Response>
  Show(HttpForm (*f)(const Request&, const Response&))
      : show_([f](const Message& request, const Message& response) {
          return f(static_cast<const Request&>(request), static_cast<const Response&>(response));
        }) {}
  explicit operator bool() const { return show_ != nullptr; }
  HttpForm operator()(const Message& request, const Message& response) const {
    return show_(request, response);
  }

 private:
  std::function<HttpForm(const Message&, const Message&)> show_;
};

/// How an operation is asked for over HTTP. What stands in braces goes into the request's field of
/// that name.
struct Route {
  const char* path;                 ///< "POST /api/v1/jobs/{job}/cancel"
  std::vector<QueryField> query{};  ///< in the order in which openapi.yaml tells them
  const BodyForm* body = nullptr;   ///< null: none is looked at
  const char* only = nullptr;       ///< the field of the response that is the answer; null: all are
  unsigned status = 200;            ///< 204: there is nothing to tell
  Show show{};                      ///< where the answer looks otherwise
  Handler handle{};                 ///< where HTTP is served otherwise than gRPC, and then
  Runs runs{};                      ///< ... on these threads
  uint64_t most_bytes = 0;          ///< of the body; 0: the operation's, or (GET) none
};

}  // namespace hyades::coordinator
