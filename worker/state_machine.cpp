// The units in hand: found by their extents, delivered, failed, dropped.
#include "worker/state_machine.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "farm/wire.h"

namespace hyades::worker {
namespace {

auto key_of(const v1::LeasedUnit& u) {
  return std::make_tuple(u.job(), u.unit().frame(), u.unit().tile().x0(), u.unit().tile().y0(),
                         u.unit().tile().x1(), u.unit().tile().y1(), u.unit().first_batch(),
                         u.unit().batches());
}

}  // namespace

farm::LogFields StateMachine::about(const v1::LeasedUnit& leased) {
  const auto unit = farm::from_wire(leased.unit());
  return {leased.job(), leased.unit().frame(), unit ? farm::unit_field(*unit) : std::string(), {}};
}

StateMachine::Items::iterator StateMachine::find(const v1::LeasedUnit& leased) {
  const auto key = key_of(leased);
  return std::find_if(items_.begin(), items_.end(),
                      [&](const auto& entry) { return key_of(entry.second.leased) == key; });
}

void StateMachine::keep_film(Items::iterator found, const pipe::UnitFilm& film) {
  Item& item = found->second;
  v1::UnitResult& result = item.result;
  *result.mutable_lease() = item.leased.lease();
  result.set_job(item.leased.job());
  *result.mutable_unit() = item.leased.unit();
  result.mutable_unit()->set_batches(film.batches());
  result.set_film(film.film());
  result.set_digest(film.digest());
  result.set_render_ns(film.render_ns());
  result.set_thread(film.thread());
  result.set_samples(film.samples());
  result.set_rays(film.rays());
  result.set_bad_samples(film.bad_samples());
  *result.mutable_notes() = film.notes();
  if (result.ByteSizeLong() > max_message_bytes_) {
    fail(found, fmt::format("its film is too large to be sent: {} bytes, the coordinator takes {}",
                            result.ByteSizeLong(), max_message_bytes_));
    return;
  }
  *item.leased.mutable_unit() = result.unit();
  item.state = Item::State::kept;
  item.suspect = false;
  ++kept_;
  kept_bytes_ += result.film().size();
  forget_idle_job(item.leased.job());
  ports_.note(farm::LogLevel::debug,
              fmt::format("rendered in {:.3g} s", static_cast<double>(film.render_ns()) * 1e-9),
              about(item.leased));
  if (!welcomed_) return;
  v1::WorkerMessage message;
  *message.mutable_result() = result;
  message.mutable_result()->set_want(take_wish());
  ports_.send(std::move(message));
}

void StateMachine::fail(Items::iterator item, const std::string& reason) {
  ports_.note(farm::LogLevel::warning, "a unit failed: " + reason, about(item->second.leased));
  v1::WorkerMessage message;
  *message.mutable_failure()->mutable_unit() = item->second.leased;
  message.mutable_failure()->set_reason(farm::wire_text(reason));
  drop(item);
  // Without a stream nobody hears it: the lease runs out, and the unit fails elsewhere.
  if (!welcomed_) return;
  message.mutable_failure()->set_want(take_wish());
  ports_.send(std::move(message));
}

void StateMachine::drop(Items::iterator item) {
  const uint64_t job = item->second.leased.job();
  if (item->second.state == Item::State::kept) {
    --kept_;
    kept_bytes_ -= item->second.result.film().size();
  }
  items_.erase(item);
  forget_idle_job(job);
}

void StateMachine::stop_rendering(Items::iterator item) {
  if (item->second.state != Item::State::rendering) return;
  pipe::ToRenderer message;
  message.mutable_stop()->set_token(item->first);
  ports_.tell_renderer(std::move(message));
}

}  // namespace hyades::worker
