// What a rendering child says to its worker: any bytes go through what reads them and judges them
// to a worker's books with three units. Whatever comes, the worker keeps to the wire's bounds,
// loses no unit, and can go on with another child.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include "farm/wire.h"
#include "tests/fuzz/fuzz.h"
#include "tests/worker/state_machine_testing.h"
#include "worker/pipe/message_pipe.h"
#include "worker/renderer_talk.h"

namespace hyades::fuzz {
namespace {

using worker::WorkerWorld;

constexpr std::array kPlaces = {0, 8, 16};
constexpr uint32_t kBatches = 4;

void demand(bool promise) {
  if (!promise) std::abort();
}

std::string digest() { return std::string(32, '\x11'); }

/// A worker that has been given units, and whose child is ready.
class Books {
 public:
  Books() : world_(2, 1) {
    world_.machine->stream_opened(world_.now);
    world_.welcome(1000, 4'000'000'000);
    v1::CoordinatorMessage job;
    job.mutable_job()->set_job(WorkerWorld::kJob);
    job.mutable_job()->mutable_spec()->set_document("job.yaml");
    job.mutable_job()->mutable_spec()->add_files()->set_sha256(digest());
    world_.machine->coordinator_says(job, world_.now);
    for (const int x : kPlaces) world_.lease(unit(x));
    world_.machine->files_are_there(WorkerWorld::kJob);
  }

  /// Whether all of `input` was sound.
  bool hear(std::string_view input) {
    worker::RendererTalk talk;
    const auto read = [&](char* to, size_t size) {
      const size_t count = std::min(size, input.size());
      std::copy_n(input.begin(), count, to);
      input.remove_prefix(count);
      return count;
    };
    world_.machine->renderer_started();
    bool sound = true;
    while (sound && world_.ports.kills.empty()) {
      pipe::FromRenderer message;
      std::string load;
      const auto more = pipe::read_message(read, worker::renderer_limits(), message, load);
      if (more && !*more) break;
      sound = more && talk.hear(message, std::move(load));
      if (!sound || message.has_not_ready()) break;
      if (message.has_ready()) {
        world_.machine->renderer_ready(message.ready());
      } else {
        world_.machine->renderer_says(message);
      }
      world_.now += std::chrono::milliseconds(100);
      world_.machine->tick(world_.now, true);
      answer();
    }
    sound = sound && world_.ports.kills.empty() && input.empty();
    world_.machine->renderer_died("ended");
    answer();
    return sound;
  }

  /// Another child renders what is left.
  void finish() {
    world_.machine->renderer_started();
    world_.renderer_up();
    for (int round = 0; round < 20 && !world_.machine->empty(); ++round) {
      const std::vector<pipe::ToRenderer> told = std::exchange(world_.ports.told, {});
      for (const pipe::ToRenderer& message : told) {
        if (message.has_unit()) world_.film(message.unit().token(), kBatches);
      }
      answer();
    }
    demand(world_.machine->empty());
    for (const int x : kPlaces) demand(settled_[x] == 1);
  }

 private:
  static v1::LeasedUnit unit(int x) {
    return WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1, WorkerWorld::kJob, kBatches);
  }

  /// What a coordinator answers, and what it may count on.
  void answer() {
    for (const v1::WorkerMessage& message : world_.take_sent()) {
      v1::WorkerMessage again;
      demand(again.ParseFromString(message.SerializeAsString()));
      const v1::UnitResult& result = message.result();
      demand(message.ByteSizeLong() - result.film().size() <= farm::kMaxWorkerTalkBytes);
      if (message.has_result()) {
        demand(result.unit().batches() >= 1 && result.unit().batches() <= kBatches);
        v1::LeasedUnit leased = unit(result.unit().tile().x0());
        leased.mutable_unit()->set_batches(result.unit().batches());
        demand(leased.unit().SerializeAsString() == result.unit().SerializeAsString());
        ++settled_[result.unit().tile().x0()];
        world_.acknowledge(leased);
      } else if (message.has_failure()) {
        demand(message.failure().reason().size() <= farm::kMaxTextBytes);
        ++settled_[message.failure().unit().unit().tile().x0()];
      }
    }
    for (const std::string& file : world_.ports.rechecked) {
      demand(file == farm::hex_from_wire(digest()));
    }
    demand(world_.machine->in_hand() <= kPlaces.size());
  }

  WorkerWorld world_;
  std::map<int, int> settled_;  ///< answers for a unit, by its place
};

}  // namespace

std::vector<std::string> seeds() {
  pipe::FromRenderer ready;
  ready.mutable_ready()->set_worker_class("class");
  ready.mutable_ready()->set_build("hyades");
  ready.mutable_ready()->set_sandbox_lacks("Landlock");
  pipe::FromRenderer not_ready;
  not_ready.mutable_not_ready()->set_reason("no class");
  pipe::FromRenderer loading;
  loading.mutable_started()->set_token(1);
  loading.mutable_started()->set_loading(true);
  pipe::FromRenderer begun;
  begun.mutable_started()->set_token(1);
  pipe::FromRenderer progress;
  progress.mutable_progress()->set_memory_bytes(1U << 20U);
  for (uint64_t token = 1; token <= 2; ++token) {
    auto& unit = *progress.mutable_progress()->add_units();
    unit.set_token(token);
    unit.set_samples_done(64);
  }
  pipe::FromRenderer film;
  film.mutable_film()->set_token(1);
  film.mutable_film()->set_batches(kBatches);
  film.mutable_film()->set_digest(std::string(32, 'd'));
  film.mutable_film()->set_render_ns(1'000'000);
  film.mutable_film()->set_samples(4096);
  film.mutable_film()->add_notes("a sample is not a number");
  film.mutable_film()->set_thread(1);
  pipe::FromRenderer failed;
  failed.mutable_failed()->set_token(2);
  failed.mutable_failed()->set_reason("asset: the stored file is damaged");
  failed.mutable_failed()->add_damaged(farm::hex_from_wire(digest()));
  failed.mutable_failed()->add_damaged(std::string(64, 'f'));
  pipe::FromRenderer returned;
  returned.mutable_returned()->set_token(3);
  const std::string hello = pipe::frame_message(ready);
  return {pipe::frame_message(not_ready), hello + pipe::frame_message(loading),
          hello + pipe::frame_message(loading) + pipe::frame_message(begun) +
              pipe::frame_message(progress) + pipe::frame_message(film, "the bytes of a film"),
          hello + pipe::frame_message(failed) + pipe::frame_message(returned)};
}

bool try_input(std::string_view input) {
  Books books;
  const bool sound = books.hear(input);
  books.finish();
  return sound;
}

}  // namespace hyades::fuzz
