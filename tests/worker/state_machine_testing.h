#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "worker/state_machine.h"

namespace hyades::worker {

/// Keeps what a state machine wants done.
class FakePorts : public WorkerPorts {
 public:
  void send(v1::WorkerMessage message) override { sent.push_back(std::move(message)); }
  void break_off(const std::string& reason) override { broken_off.push_back(reason); }
  void tell_renderer(pipe::ToRenderer message) override { told.push_back(std::move(message)); }
  void kill_renderer(const std::string& reason) override { kills.push_back(reason); }
  void fetch(uint64_t job, const v1::JobSpec& /*spec*/) override { fetched.push_back(job); }
  void recheck(const std::string& file) override { rechecked.push_back(file); }
  void release(uint64_t job) override { released.push_back(job); }
  bool has_files(uint64_t /*job*/) override { return files_are_kept; }
  void note(farm::LogLevel level, const std::string& text, const farm::LogFields& about) override {
    if (level == farm::LogLevel::debug) return;
    notes.push_back(text);
    noted.push_back(about);
  }

  std::vector<v1::WorkerMessage> sent;
  std::vector<pipe::ToRenderer> told;
  std::vector<std::string> broken_off;  ///< streams: why
  std::vector<std::string> kills;
  std::vector<uint64_t> fetched;
  std::vector<uint64_t> released;
  bool files_are_kept = true;  ///< those of every job
  std::vector<std::string> rechecked;
  std::vector<std::string> notes;      ///< but for those of level debug
  std::vector<farm::LogFields> noted;  ///< what they were about
};

/// A state machine with a clock, and short ways to say what happens to it.
class WorkerWorld {
 public:
  static constexpr uint64_t kJob = 7;

  explicit WorkerWorld(uint32_t threads = 2, uint32_t ahead = 1) {
    StateMachineOptions options;
    options.worker_id = "0123456789abcdef";
    options.threads = threads;
    options.ahead = ahead;
    options.max_kept_bytes = 1000;
    options.max_brief_bytes = uint64_t{1} << 20U;
    options.hang_limit = std::chrono::seconds(60);
    options.unit_limit = std::chrono::minutes(30);
    machine.emplace(options, ports);
  }

  void renderer_up() {
    pipe::Ready ready;
    ready.set_worker_class("class");
    machine->renderer_ready(ready);
  }
  void welcome(uint32_t heartbeat_ms = 1000, uint32_t lease_ms = 10'000) {
    v1::CoordinatorMessage message;
    message.mutable_welcome()->set_heartbeat_ms(heartbeat_ms);
    message.mutable_welcome()->set_lease_ms(lease_ms);
    machine->coordinator_says(message, now);
  }
  /// `digests`: of the files that it names, 32 bytes each.
  void job(uint64_t id = kJob, const std::vector<std::string>& digests = {},
           const std::string& name = {}) {
    v1::CoordinatorMessage message;
    message.mutable_job()->mutable_spec()->set_name(name);
    message.mutable_job()->set_job(id);
    message.mutable_job()->mutable_spec()->set_document("job.yaml");
    for (const std::string& digest : digests) {
      message.mutable_job()->mutable_spec()->add_files()->set_sha256(digest);
    }
    machine->coordinator_says(message, now);
  }
  /// Everything up to where units can come.
  void begin(uint32_t heartbeat_ms = 1000, uint32_t lease_ms = 10'000) {
    renderer_up();
    machine->stream_opened(now);
    welcome(heartbeat_ms, lease_ms);
    job();
  }

  static v1::LeasedUnit unit(int x, uint64_t lease = 1, uint64_t id = kJob, uint32_t batches = 4) {
    v1::LeasedUnit leased;
    leased.mutable_lease()->set_incarnation(1);
    leased.mutable_lease()->set_number(lease);
    leased.set_job(id);
    leased.mutable_unit()->set_frame(1);
    leased.mutable_unit()->mutable_tile()->set_x0(x);
    leased.mutable_unit()->mutable_tile()->set_x1(x + 8);
    leased.mutable_unit()->mutable_tile()->set_y1(8);
    leased.mutable_unit()->set_batches(batches);
    return leased;
  }
  void lease(const v1::LeasedUnit& leased, bool adopted = false) {
    v1::CoordinatorMessage message;
    *message.mutable_lease()->mutable_lease() = leased.lease();
    message.mutable_lease()->set_job(leased.job());
    *message.mutable_lease()->add_units() = leased.unit();
    message.mutable_lease()->set_adopted(adopted);
    machine->coordinator_says(message, now);
  }
  void acknowledge(const v1::LeasedUnit& leased) {
    v1::CoordinatorMessage message;
    *message.mutable_acknowledge()->mutable_unit() = leased;
    machine->coordinator_says(message, now);
  }

  void stop(const v1::LeasedUnit& leased) {
    v1::CoordinatorMessage message;
    *message.mutable_stop()->mutable_unit() = leased;
    machine->coordinator_says(message, now);
  }

  void echo(uint64_t number) {
    v1::CoordinatorMessage message;
    message.mutable_echo()->set_number(number);
    machine->coordinator_says(message, now);
  }

  void started(uint64_t token, bool loading = false) {
    pipe::FromRenderer message;
    message.mutable_started()->set_token(token);
    message.mutable_started()->set_loading(loading);
    machine->renderer_says(message);
  }
  void film(uint64_t token, uint32_t batches = 4, size_t bytes = 10) {
    pipe::FromRenderer message;
    message.mutable_film()->set_token(token);
    message.mutable_film()->set_batches(batches);
    message.mutable_film()->set_film(std::string(bytes, 'f'));
    machine->renderer_says(message);
  }
  /// `damaged`: names of files, in hexadecimal.
  void failed(uint64_t token, const std::vector<std::string>& damaged) {
    pipe::FromRenderer message;
    message.mutable_failed()->set_token(token);
    message.mutable_failed()->set_reason("asset " + damaged.front().substr(0, 2) +
                                         "...: the stored file is damaged");
    for (const std::string& name : damaged) message.mutable_failed()->add_damaged(name);
    machine->renderer_says(message);
  }
  void progress(const std::map<uint64_t, uint64_t>& samples_by_token) {
    pipe::FromRenderer message;
    message.mutable_progress();
    for (const auto& [token, samples] : samples_by_token) {
      auto& unit = *message.mutable_progress()->add_units();
      unit.set_token(token);
      unit.set_samples_done(samples);
    }
    machine->renderer_says(message);
  }
  void returned(uint64_t token) {
    pipe::FromRenderer message;
    message.mutable_returned()->set_token(token);
    machine->renderer_says(message);
  }

  /// The token under which the child was told of the unit at `x`, lately; 0: it was not.
  uint64_t token_of(int x) const {
    uint64_t token = 0;
    for (const pipe::ToRenderer& message : ports.told) {
      if (message.has_unit() && message.unit().unit().tile().x0() == x) {
        token = message.unit().token();
      }
    }
    return token;
  }
  bool stopped(uint64_t token) const {
    for (const pipe::ToRenderer& message : ports.told) {
      if (message.has_stop() && message.stop().token() == token) return true;
    }
    return false;
  }
  /// What was sent since the last call.
  std::vector<v1::WorkerMessage> take_sent() { return std::exchange(ports.sent, {}); }

  FakePorts ports;
  std::optional<StateMachine> machine;
  TimePoint now{std::chrono::hours(1)};
};

/// The first of `messages` that `has` something; a default one where there is none.
template <class Has>
v1::WorkerMessage first(const std::vector<v1::WorkerMessage>& messages, Has has) {
  for (const v1::WorkerMessage& message : messages) {
    if ((message.*has)()) return message;
  }
  return {};
}

}  // namespace hyades::worker
