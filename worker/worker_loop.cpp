#include "worker/worker_loop.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include "worker/asset_fetcher.h"
#include "worker/coordinator_session.h"
#include "worker/departure.h"
#include "worker/renderer_supervisor.h"
#include "worker/worker_context.h"

namespace hyades::worker {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTick{50};
constexpr milliseconds kFetchPatience{60'000};

/// Posts what comes of fetching to the loop.
class FetchedFiles : public AssetFetcher::Listener {
 public:
  explicit FetchedFiles(const WorkerContext& worker) : worker_(worker) {}
  void files_are_there(uint64_t job) override {
    worker_.loop.post([this, job] { worker_.machine.files_are_there(job); });
  }
  void files_failed(uint64_t job, const std::string& reason, FilesTrouble trouble) override {
    worker_.loop.post([this, job, reason, trouble] {
      worker_.machine.files_failed(job, reason, trouble, Clock::now());
    });
  }

 private:
  const WorkerContext worker_;
};

StateMachineOptions machine_options(const WorkerOptions& options, const WorkerIdentity& id,
                                    const std::string& instance, const std::string& name) {
  StateMachineOptions machine;
  machine.worker_id = id.text();
  machine.instance = instance;
  machine.hang_limit = in_seconds(options.hang_limit);
  machine.unit_limit = in_seconds(options.unit_limit);
  machine.name = name;
  machine.host = host_name();
  machine.threads = static_cast<uint32_t>(options.threads);
  machine.ahead = machine.threads;
  machine.memory_bytes = options.memory;
  machine.tags = options.tags;
  return machine;
}

/// Puts the parts together, and does for the state machine what it wants done.
class Worker : private WorkerPorts {
 public:
  Worker(const WorkerOptions& options, WorkerIdentity id, const std::string& instance,
         const std::shared_ptr<farm::Channels>& channels, WorkerToken token,
         farm::ContentStore& store)
      : options_(options),
        name_(options.name.empty() ? host_name() : options.name),
        log_(name_),
        machine_(machine_options(options, id, instance, name_), *this),
        renderer_(context()),
        fetched_(context()),
        fetcher_(channels, token.text(), store, fetched_, kFetchPatience),
        session_(context(), std::move(id), channels, std::move(token),
                 [this](const std::string& renewed) { fetcher_.set_token(renewed); }),
        departure_(context(), renderer_, session_, Clock::now()) {}

  int run(const volatile std::sig_atomic_t& signals) {
    renderer_.start();
    departure_.watch_for_preemption();
    while (!loop_.ended()) {
      loop_.run_posted(kTick);
      const TimePoint now = Clock::now();
      if (signals > 0) departure_.asked(now);
      departure_.leave_if_idle(now);
      renderer_.tick(now);
      session_.tick(now, renderer_.ready());
      machine_.cache_is(
          {fetcher_.cache_bytes(), options_.cache_size, fetcher_.hits(), fetcher_.misses()});
      machine_.tick(now, session_.flowing());
      departure_.try_to_go(now);
    }
    return *loop_.ended();
  }

 private:
  WorkerContext context() { return {options_, loop_, log_, machine_}; }

  void send(v1::WorkerMessage message) override { session_.send(std::move(message)); }
  void break_off(const std::string& reason) override { session_.break_off(reason); }
  void tell_renderer(pipe::ToRenderer message) override { renderer_.tell(std::move(message)); }
  void kill_renderer(const std::string& reason) override { renderer_.kill(reason); }
  void fetch(uint64_t job, const v1::JobSpec& spec) override { fetcher_.fetch(job, spec); }
  void recheck(const std::string& file) override { fetcher_.recheck(file); }
  void release(uint64_t job) override { fetcher_.release(job); }
  bool has_files(uint64_t job) override { return fetcher_.has_files(job); }
  void note(farm::LogLevel level, const std::string& text, const farm::LogFields& about) override {
    log_.note(level, text, about);
  }

  const WorkerOptions options_;
  const std::string name_;
  EventLoop loop_;
  WorkerLog log_;
  StateMachine machine_;

  // Their threads post to the above.
  RendererSupervisor renderer_;
  FetchedFiles fetched_;
  AssetFetcher fetcher_;
  CoordinatorSession session_;
  Departure departure_;
};

}  // namespace

int work(const WorkerOptions& options, WorkerIdentity id, const std::string& instance,
         std::shared_ptr<farm::Channels> channels, WorkerToken token, farm::ContentStore& store,
         const volatile std::sig_atomic_t& signals) {
  Worker worker(options, std::move(id), instance, channels, std::move(token), store);
  return worker.run(signals);
}

}  // namespace hyades::worker
