#include "coordinator/controller/dispatcher.h"

#include <chrono>

namespace hyades::coordinator {

Turn::Turn(Dispatcher& dispatcher) HYADES_NO_THREAD_SAFETY_ANALYSIS : dispatcher_(dispatcher),
                                                                      lock_(dispatcher.mutex_) {}

Turn::~Turn() HYADES_NO_THREAD_SAFETY_ANALYSIS {
  lock_.unlock();
  for (const DeferredAction& action : deferred_) dispatcher_.handler_->carry_out(action);
}

void Turn::tell(const Event& event, Delivery* delivery) {
  dispatcher_.handler_->act(dispatcher_.scheduler_.handle(event, std::chrono::steady_clock::now()),
                            *this, delivery);
}

}  // namespace hyades::coordinator
