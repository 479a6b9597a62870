// A real coordinator process and simulated workers over real gRPC (loopback): leases granted, and 4
// KB results checked, merged and durably acknowledged, per second. The workers render nothing:
// their films are made before. usage: bench_farm [SECONDS [STREAMS [TILE-HEIGHT [FOLDER]]]]
#include <sys/resource.h>

#include <atomic>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>

#include "core/film/film_codec.h"
#include "hyades/v1/work.grpc.pb.h"
#include "tests/bench/bench_coordinator.h"
#include "tests/coordinator/services/fake_films.h"

namespace hyades::bench {
namespace {

constexpr int kTile = 32;
constexpr int kTiles = 120;
constexpr uint32_t kBatches = 200;
constexpr uint32_t kThreadsOfWorker = 16;
constexpr uint64_t kRenderNs = 5'000'000'000;  // what a unit shall take: units stay one batch long

struct Counts {
  std::atomic<uint64_t> leased{0};
  std::atomic<uint64_t> acknowledged{0};
  std::atomic<uint64_t> refused{0};
};

/// The films of one frame's units of one batch; every frame gets the same.
class Films {
 public:
  explicit Films(int height) {
    const core::FilmLayout layout = core::make_film_layout({});
    for (int tile = 0; tile < kTiles; ++tile) {
      for (uint32_t batch = 0; batch < kBatches; ++batch) {
        const core::Unit unit{1, {tile * kTile, 0, (tile + 1) * kTile, height}, {batch, 1}};
        const core::Film film =
            coordinator::fake_film(unit, kBatches * core::kBatchSamples, layout);
        const std::vector<std::byte> bytes = core::encode_film(film);
        bytes_ += bytes.size();
        films_.push_back({std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                          farm::to_wire(*farm::digest_from_hex(film.digest()))});
      }
    }
  }

  struct Made {
    std::string film;
    std::string digest;
  };
  /// Null for a unit of several batches.
  const Made* of(const v1::Unit& unit) const {
    if (unit.batches() != 1) return nullptr;
    return &films_.at(static_cast<size_t>(unit.tile().x0() / kTile) * kBatches +
                      unit.first_batch());
  }
  size_t mean_bytes() const { return bytes_ / films_.size(); }

 private:
  std::vector<Made> films_;
  size_t bytes_ = 0;
};

/// One worker's stream: answers every lease at once, each result with the wish for the next.
class Worker final : public grpc::ClientBidiReactor<v1::WorkerMessage, v1::CoordinatorMessage> {
 public:
  Worker(v1::Work::Stub& stub, int number, const Films& films, Counts& counts)
      : films_(films), counts_(counts) {
    farm::prepare(context_, {}, std::chrono::milliseconds(0));
    context_.set_wait_for_ready(true);
    stub.async()->Attend(&context_, this);
    v1::WorkerMessage message;
    v1::Hello& hello = *message.mutable_hello();
    hello.set_protocol(farm::kProtocol);
    hello.set_worker_id("simulated-worker-" + std::to_string(1000 + number));
    hello.set_instance(hello.worker_id());
    hello.set_name("simulated/" + std::to_string(number));
    hello.set_worker_class("simulated");
    hello.set_threads(kThreadsOfWorker);
    hello.set_want(2 * kThreadsOfWorker);
    AddHold();
    send(std::move(message));
    StartRead(&incoming_);
    StartCall();
  }

  /// Breaks the stream and waits for its end.
  void end() {
    context_.TryCancel();
    while (!over_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  void OnReadDone(bool ok) override {
    if (!ok) {
      {
        const std::lock_guard lock(mutex_);
        broken_ = true;
      }
      RemoveHold();
      return;
    }
    if (incoming_.has_lease()) {
      deliver(incoming_.lease());
    } else if (incoming_.has_acknowledge()) {
      ++counts_.acknowledged;
    } else if (incoming_.has_rejected()) {
      ++counts_.refused;
    }
    StartRead(&incoming_);
  }

  void OnWriteDone(bool /*ok: a broken stream is noticed by reading*/) override {
    const std::lock_guard lock(mutex_);
    outgoing_.pop_front();
    if (!broken_ && !outgoing_.empty()) StartWrite(&outgoing_.front());
  }

  void OnDone(const grpc::Status& /*it is cancelled*/) override { over_ = true; }

 private:
  void deliver(const v1::Lease& lease) {
    ++counts_.leased;
    for (const v1::Unit& unit : lease.units()) {
      v1::WorkerMessage message;
      v1::UnitResult& result = *message.mutable_result();
      *result.mutable_lease() = lease.lease();
      result.set_job(lease.job());
      *result.mutable_unit() = unit;
      const Films::Made* made = films_.of(unit);
      if (made == nullptr) give_up("a unit of several batches was leased");
      result.set_film(made->film);
      result.set_digest(made->digest);
      result.set_render_ns(kRenderNs);
      result.set_want(1);
      send(std::move(message));
    }
  }

  void send(v1::WorkerMessage message) {
    const std::lock_guard lock(mutex_);
    outgoing_.push_back(std::move(message));
    if (!broken_ && outgoing_.size() == 1) StartWrite(&outgoing_.front());
  }

  const Films& films_;
  Counts& counts_;
  grpc::ClientContext context_;
  v1::CoordinatorMessage incoming_;
  std::mutex mutex_;
  std::deque<v1::WorkerMessage> outgoing_;  ///< the first is being written
  bool broken_ = false;
  std::atomic<bool> over_{false};
};

double own_cpu() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void measure(double seconds, int streams, int height, const std::string& folder) {
  const Films films(height);
  const CoordinatorProcess coordinator(folder);
  const auto channel = coordinator.connect();
  submit(channel, "hyades: 1\nname: noise\nframes: {range: 1-1000}\nfilm: {size: [" +
                      std::to_string(kTile * kTiles) + ", " + std::to_string(height) +
                      "]}\nsampling: {samples: " + std::to_string(kBatches * core::kBatchSamples) +
                      "}\nenvironment: {color: 1}\noutputs: [{file: noise.####.exr}]\n");
  const auto stub = v1::Work::NewStub(channel);
  Counts counts;
  std::vector<std::unique_ptr<Worker>> workers;
  for (int i = 0; i < streams; ++i) {
    workers.push_back(std::make_unique<Worker>(*stub, i, films, counts));
  }
  while (counts.acknowledged < 1000) std::this_thread::sleep_for(std::chrono::milliseconds(10));

  const auto begin = std::chrono::steady_clock::now();
  const uint64_t leased = counts.leased;
  const uint64_t acknowledged = counts.acknowledged;
  const double cpu = cpu_seconds(coordinator.process());
  const double own = own_cpu();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto done = static_cast<double>(counts.acknowledged - acknowledged);
  const auto granted = static_cast<double>(counts.leased - leased);
  std::printf(
      "%.0f leases and %.0f results/s of %zu bytes, durable and acknowledged, over %d streams "
      "of one connection without TLS (many_workers: one each, with TLS); per "
      "result %.0f us of CPU in the coordinator, %.0f us in the simulated workers; %llu refused\n",
      granted / wall, done / wall, films.mean_bytes(), streams,
      1e6 * (cpu_seconds(coordinator.process()) - cpu) / done, 1e6 * (own_cpu() - own) / done,
      static_cast<unsigned long long>(counts.refused.load()));
  std::fflush(stdout);
  for (const auto& worker : workers) worker->end();
}

}  // namespace
}  // namespace hyades::bench

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
  };
  const double seconds = number(1, 10);
  const int streams = static_cast<int>(number(2, 16));
  const int height = static_cast<int>(number(3, 5));
  if (seconds <= 0 || streams < 1 || height < 1 || height > 32) {
    std::fprintf(stderr, "usage: %s [SECONDS [STREAMS [TILE-HEIGHT 1..32 [FOLDER]]]]\n", argv[0]);
    return 2;
  }
  const hyades::test::TempFolder scratch;
  hyades::bench::measure(seconds, streams, height, argc > 4 ? argv[4] : scratch.file("data"));
}
