// The worker's side of the stream: hello, leases, answers to films, wishes.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "farm/wire.h"
#include "worker/state_machine.h"

namespace hyades::worker {
namespace {

constexpr Duration kShortestHeartbeat = std::chrono::milliseconds(100);
constexpr Duration kShortestLease = std::chrono::seconds(1);
constexpr Duration kResendAfter = std::chrono::milliseconds(200);
constexpr Duration kAskAgainAfter = std::chrono::seconds(1);
/// Bytes of a unit's proof, which are 16.
constexpr size_t kLongestProof = 1000;

Duration in_milliseconds(uint64_t count) { return std::chrono::milliseconds(count); }

}  // namespace

void StateMachine::stream_opened(TimePoint now) {
  fence(now);
  open_ = true;
  welcomed_ = false;
  wished_ = 0;
  to_be_adopted_ = 0;
  hello_sent_ = now;
  unanswered_.clear();
  for (auto& [id, job] : jobs_) job.spec_sent = false;
  if (!worker_class_.empty()) send_hello();
}

void StateMachine::stream_closed() {
  open_ = false;
  welcomed_ = false;
  wished_ = 0;
}

/// The coordinator does what none should, and would cost this machine more and more.
void StateMachine::break_off(const std::string& reason) {
  stream_closed();
  ports_.break_off("the coordinator " + reason);
}

void StateMachine::send_hello() {
  v1::WorkerMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol(farm::kProtocol);
  hello.set_worker_id(options_.worker_id);
  hello.set_instance(options_.instance);
  hello.set_keeps_token(true);
  hello.set_name(options_.name);
  hello.set_host(options_.host);
  hello.set_worker_class(worker_class_);
  hello.set_portable_class(portable_class_);
  hello.set_build(build_);
  hello.set_threads(options_.threads);
  hello.set_memory_bytes(options_.memory_bytes);
  for (const std::string& tag : options_.tags) hello.add_tags(tag);
  for (const auto& [token, item] : items_) *hello.add_in_hand() = item.leased;
  to_be_adopted_ = items_.size();
  hello.set_want(take_wish());
  ports_.send(std::move(message));
}

void StateMachine::coordinator_says(v1::CoordinatorMessage message, TimePoint now) {
  fence(now);
  if (!open_) return;
  switch (message.message_case()) {
    case v1::CoordinatorMessage::kWelcome:
      welcomed(message.welcome(), now);
      break;
    case v1::CoordinatorMessage::kJob:
      add_job(message.job());
      break;
    case v1::CoordinatorMessage::kLease:
      if (!renewed_) renewed_ = now;  // units were given up, and here are others
      take(message.lease(), now);
      break;
    case v1::CoordinatorMessage::kAcknowledge:
      acknowledged(message.acknowledge().unit());
      break;
    case v1::CoordinatorMessage::kRejected:
      rejected(message.rejected(), now);
      break;
    case v1::CoordinatorMessage::kStop:
      unwanted(message.stop().unit());
      break;
    case v1::CoordinatorMessage::kDrain:
      drained(farm::wire_text(message.drain().reason()));
      break;
    case v1::CoordinatorMessage::kOver:
      job_over(message.over().job());
      break;
    case v1::CoordinatorMessage::kEcho:
      echoed(message.echo().number());
      break;
    case v1::CoordinatorMessage::MESSAGE_NOT_SET:
      break;
  }
  dispatch();
  top_up();
}

void StateMachine::welcomed(const v1::Welcome& welcome, TimePoint now) {
  // Each would send all films again, and tell people.
  if (welcomed_) return break_off("welcomed this worker twice");
  heartbeat_every_ = std::max(in_milliseconds(welcome.heartbeat_ms()), kShortestHeartbeat);
  lease_time_ = std::max(in_milliseconds(welcome.lease_ms()), kShortestLease);
  if (welcome.max_message_bytes() > 0) max_message_bytes_ = welcome.max_message_bytes();
  welcomed_ = true;
  renewed_ = hello_sent_;
  last_heartbeat_ = now;
  for (auto& [token, item] : items_) {
    if (item.state == Item::State::kept) send_result(item);
    item.send_again.reset();
  }
  if (leaving_) say_leaving();
}

void StateMachine::add_job(const v1::JobBrief& brief) {
  const auto [there, added] = jobs_.try_emplace(brief.job(), static_cast<uint32_t>(brief.job()));
  Job& job = there->second;
  if (!added) brief_bytes_ -= bytes_of(job);
  brief.spec().SerializeToString(&job.spec);
  brief_bytes_ += bytes_of(job);
  job.spec_sent = true;
  job.over = false;
  job.hopeless.clear();
  if (brief_bytes_ > options_.max_brief_bytes) forget_former_jobs();
  if (brief_bytes_ > options_.max_brief_bytes) {
    break_off("told of more jobs than all that a farm has");
  }
}

/// Those that ended while there was no stream: nobody tells of them again.
void StateMachine::forget_former_jobs() {
  for (auto it = jobs_.begin(); it != jobs_.end();) {
    const auto job = it++;
    if (job->second.spec_sent) continue;
    job->second.over = true;
    forget_idle_job(job->first);
  }
}

void StateMachine::job_over(uint64_t id) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return;
  job->second.over = true;
  for (auto it = items_.begin(); it != items_.end();) {
    const auto item = it++;
    if (item->second.leased.job() != id) continue;
    stop_rendering(item);
    drop(item);
  }
  forget_idle_job(id);
}

void StateMachine::take(const v1::Lease& lease, TimePoint now) {
  const auto units = static_cast<uint64_t>(lease.units_size());
  uint64_t& expected = lease.adopted() ? to_be_adopted_ : wished_;
  if (units > expected) return break_off("leases units that nobody asked for");
  expected -= units;
  for (const v1::Unit& unit : lease.units()) {
    if (unit.proof().size() > kLongestProof) return break_off("sent a proof that is none");
    v1::LeasedUnit leased;
    *leased.mutable_lease() = lease.lease();
    leased.set_job(lease.job());
    *leased.mutable_unit() = unit;
    take_unit(leased, lease.adopted(), now);
  }
}

void StateMachine::take_unit(const v1::LeasedUnit& leased, bool adopted, TimePoint now) {
  if (const auto there = find(leased); there != items_.end()) {
    Item& item = there->second;
    *item.leased.mutable_lease() = leased.lease();
    if (item.state != Item::State::kept) return;
    *item.result.mutable_lease() = leased.lease();
    // After Welcome every film was sent; a new lease means that this one did not count.
    if (!adopted) send_result(item);
    return;
  }
  const auto job = jobs_.find(leased.job());
  // Asked for before the rest began.
  const bool rests = rests_until_ && job != jobs_.end() && !job->second.has_files;
  if (job == jobs_.end() || adopted || leaving_ || rests) {
    return give_back(leased, leaving_  ? leaving_reason_
                             : adopted ? "given up meanwhile"
                             : rests   ? files_trouble_
                                       : "the job is not known");
  }
  if (job->second.rests_until && !job->second.has_files && held() >= enough()) {
    asks_again_ = now + kAskAgainAfter;
    return give_back(leased, job->second.trouble);
  }
  Item item;
  item.leased = leased;
  item.state = job->second.has_files ? Item::State::waiting : Item::State::fetching;
  const auto taken = items_.emplace(next_token_++, std::move(item)).first;
  if (!job->second.hopeless.empty()) return fail(taken, std::string(job->second.hopeless));
  fetch_files(leased.job(), job->second);
}

void StateMachine::give_back(const v1::LeasedUnit& leased, const std::string& reason) {
  v1::WorkerMessage message;
  *message.mutable_returned()->add_units() = leased;
  message.mutable_returned()->set_reason(reason);
  ports_.send(std::move(message));
}

void StateMachine::acknowledged(const v1::LeasedUnit& unit) {
  const auto item = find(unit);
  if (item == items_.end() || item->second.state != Item::State::kept) return;
  ports_.note(farm::LogLevel::debug, "its film is kept", about(item->second.leased));
  drop(item);
}

void StateMachine::unwanted(const v1::LeasedUnit& unit) {
  const auto item = find(unit);
  if (item == items_.end()) return;
  stop_rendering(item);
  drop(item);
}

void StateMachine::rejected(const v1::Rejected& message, TimePoint now) {
  const auto item = find(message.unit());
  if (item == items_.end()) return;
  if (message.reason() == v1::Rejected::REASON_NOT_NOW) {
    item->second.send_again =
        now + std::max(in_milliseconds(message.retry_after_ms()), kResendAfter);
    return;
  }
  ports_.note(
      farm::LogLevel::warning,
      "a film was refused: " + (message.text().empty() ? v1::Rejected::Reason_Name(message.reason())
                                                       : farm::wire_text(message.text())),
      about(message.unit()));
  stop_rendering(item);
  drop(item);
}

void StateMachine::send_result(const Item& item) {
  v1::WorkerMessage message;
  *message.mutable_result() = item.result;
  ports_.send(std::move(message));
}

// ---- wishes ----

/// How many units more to ask for now; they are counted as asked for.
uint32_t StateMachine::take_wish() {
  if (leaving_ || rests_until_ || asks_again_) return 0;
  if (kept_bytes_ > options_.max_kept_bytes || kept_ > options_.max_kept) return 0;
  const size_t in_work = items_.size() - kept_ - held() + wished_;
  const auto wish = static_cast<uint32_t>(enough() - std::min(enough(), in_work));
  wished_ += wish;
  return wish;
}

void StateMachine::top_up() {
  if (!welcomed_) return;
  const uint32_t wish = take_wish();
  if (wish == 0) return;
  v1::WorkerMessage message;
  message.mutable_request()->set_units(wish);
  ports_.send(std::move(message));
}

}  // namespace hyades::worker
