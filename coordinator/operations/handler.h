#pragma once

#include <functional>
#include <type_traits>
#include <utility>

#include <google/protobuf/message.h>
#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"

namespace hyades::coordinator {

class Authority;
class Controller;

using google::protobuf::Message;

/// The coordinator, as handlers get it.
struct Backend {
  Controller& controller;
  Authority& authority;
};

/// Takes what became of a request: called exactly once, by any thread. The response counts where
/// the status is OK.
template <class Response>
using Respond = std::function<void(const grpc::Status&, const Response&)>;

/// What an operation does, whatever its messages are. Made of a function of one of these forms:
///
///   grpc::Status f(Backend&, Request&, Response&)
///   grpc::Status f(Backend&, Request&, Response&, const Caller&)
///   void f(Backend&, Request&, const Respond<Response>&)       which may respond later
///   void f(Backend&, Request&, const Respond<Response>&, const Caller&)
///
/// The first may have another beside it that answers out of memory, or says no where it would have
/// to wait: bool known(Backend&, Request&, Response&).
class Handler {
 public:
  Handler() = default;
  template <class Request, class Response>
  Handler(grpc::Status (*f)(Backend&, Request&, Response&),
          bool (*known)(Backend&, Request&, Response&) = nullptr)
      : Handler(types<Request, Response>()) {
    now_ = [f](Backend& at, Message& request, Message& response, const Caller&) {
      return f(at, static_cast<Request&>(request), static_cast<Response&>(response));
    };
    if (known == nullptr) return;
    known_ = [known](Backend& at, Message& request, Message& response) {
      return known(at, static_cast<Request&>(request), static_cast<Response&>(response));
    };
  }
  template <class Request, class Response>
  Handler(grpc::Status (*f)(Backend&, Request&, Response&, const Caller&))
      : Handler(types<Request, Response>()) {
    now_ = [f](Backend& at, Message& request, Message& response, const Caller& caller) {
      return f(at, static_cast<Request&>(request), static_cast<Response&>(response), caller);
    };
  }
  template <class Request, class Response>
  Handler(void (*f)(Backend&, Request&, const Respond<Response>&))
      : Handler(types<Request, Response>()) {
    later_ = [f](Backend& at, Message& request, const Respond<Message>& respond, const Caller&) {
      f(at, static_cast<Request&>(request), respond);
    };
  }
  template <class Request, class Response>
  Handler(void (*f)(Backend&, Request&, const Respond<Response>&, const Caller&))
      : Handler(types<Request, Response>()) {
    later_ = [f](Backend& at, Message& request, const Respond<Message>& respond,
                 const Caller& caller) { f(at, static_cast<Request&>(request), respond, caller); };
  }

  /// Whether there is a function.
  explicit operator bool() const { return types_.request != nullptr; }
  /// Empty messages of the function's types.
  const Message& request() const { return *types_.request; }
  const Message& response() const { return *types_.response; }

  /// Whether it may know the answer without waiting.
  bool has_memory() const { return known_ != nullptr; }
  /// The answer out of memory; false where it is not there.
  bool answer(Backend& at, Message& request, Message& response) const {
    return known_(at, request, response);
  }
  /// Calls the function, and `respond` once, perhaps later. `reads`: it changes nothing, so that it
  /// may break off where there is no memory.
  void run(Backend& at, Message& request, const Caller& caller, bool reads,
           const Respond<Message>& respond) const;

 private:
  struct Types {
    const Message* request = nullptr;
    const Message* response = nullptr;
  };
  template <class Request, class Response>
  static Types types() {
    return {&std::remove_const_t<Request>::default_instance(), &Response::default_instance()};
  }
  explicit Handler(Types types) : types_(types) {}

  Types types_;
  std::function<grpc::Status(Backend&, Message&, Message&, const Caller&)> now_;
  std::function<bool(Backend&, Message&, Message&)> known_;
  std::function<void(Backend&, Message&, const Respond<Message>&, const Caller&)> later_;
};

}  // namespace hyades::coordinator
