// Leaving: no more work, and what goes back.
#include <string>
#include <utility>

#include "worker/state_machine.h"

namespace hyades::worker {

void StateMachine::say_leaving() {
  v1::WorkerMessage message;
  message.mutable_leaving()->set_reason(leaving_reason_);
  ports_.send(std::move(message));
}

void StateMachine::drained(const std::string& why) {
  if (!leaving_) ports_.note(farm::LogLevel::info, "drained: what is leased is finished", {});
  leave(why.empty() ? "drained" : "drained: " + why, false);
}

void StateMachine::leave(const std::string& reason, bool hand_over) {
  if (!leaving_) {
    leaving_ = true;
    leaving_reason_ = reason;
    if (welcomed_) say_leaving();
  }
  if (!hand_over || handing_over_) return;
  handing_over_ = true;
  give_back_rest(reason);
  pipe::ToRenderer message;
  message.mutable_hand_over();
  ports_.tell_renderer(std::move(message));
}

void StateMachine::give_back_rest(const std::string& reason) {
  v1::WorkerMessage message;
  message.mutable_returned()->set_reason(reason);
  for (auto it = items_.begin(); it != items_.end();) {
    const auto item = it++;
    if (item->second.state > Item::State::waiting) continue;
    *message.mutable_returned()->add_units() = item->second.leased;
    drop(item);
  }
  if (welcomed_ && message.returned().units_size() > 0) ports_.send(std::move(message));
}

}  // namespace hyades::worker
