#include "worker/worker_loop.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/backoff.h"
#include "farm/log.h"
#include "farm/token_term.h"
#include "farm/wire.h"
#include "worker/asset_fetcher.h"
#include "worker/clouds/preemption_watch.h"
#include "worker/coordinator_link.h"
#include "worker/desk.h"
#include "worker/idle_watch.h"
#include "worker/renderer_process.h"

namespace hyades::worker {
namespace {

using Clock = std::chrono::steady_clock;
using farm::LogLevel;
using std::chrono::milliseconds;

constexpr milliseconds kTick{50};
/// A child that dies sooner than this is not started again at once.
constexpr std::chrono::seconds kHealthyLife{5};
/// Deaths in a row before a first Ready that make the worker give up.
constexpr int kMostStillbirths = 3;
constexpr milliseconds kFetchPatience{60'000};
/// How long a worker whose token is unknown all at once looks for another in its file.
constexpr std::chrono::minutes kTokenPatience{5};
constexpr std::chrono::hours kTellExpiryAgain{24};
/// However long a coordinator asks not to be called.
constexpr milliseconds kLongestPause{60'000};
/// How long the end of the stream may take when all is said.
constexpr milliseconds kGoodbye{200};
/// What is left of a cloud's notice, in seconds, when the worker is gone.
constexpr double kLastSeconds = 3;
/// However long a cloud's notice is, in seconds.
constexpr double kLongestLeave = 120;

Duration seconds(double value) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(value));
}

/// What tells a folder from another of the same name; zeros where there is none.
using FolderIdentity = std::pair<dev_t, ino_t>;

FolderIdentity folder_identity(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

/// One loop that everything happens in: other threads only post to it.
class Worker : private DeskPorts,
               private CoordinatorLink::Owner,
               private RendererProcess::Owner,
               private AssetFetcher::Owner,
               private PreemptionWatch::Owner {
 public:
  Worker(const WorkerOptions& options, WorkerId id, const std::string& instance,
         std::shared_ptr<grpc::Channel> channel, std::string token, farm::ContentStore& store)
      : options_(options),
        id_(std::move(id)),
        name_(options.name.empty() ? host_name() : options.name),
        idle_(seconds(options.idle_limit), Clock::now()),
        desk_(desk_options(options, id_, instance), *this),
        token_(std::move(token)),
        link_(channel, token_, *this),
        fetcher_(channel, token_, store, *this, kFetchPatience) {}

  int run(const volatile std::sig_atomic_t& signals) {
    start_renderer();
    watch_for_preemption();
    while (!exit_status_) {
      run_posted();
      const TimePoint now = Clock::now();
      if (signals > 0) asked_to_leave(now);
      if (idle_.over(now, busy()) && !desk_.leaving()) leave_idle(now);
      if (restart_at_ && now >= *restart_at_ && !leave_by_) start_renderer();
      if (connect_at_ && now >= *connect_at_) connect(now);
      desk_.cache_is(
          {fetcher_.cache_bytes(), options_.cache_size, fetcher_.hits(), fetcher_.misses()});
      desk_.tick(now, link_.flowing());
      tell_expiry(now);
      if (desk_.leaving()) try_to_go(now);
    }
    return *exit_status_;
  }

 private:
  static DeskOptions desk_options(const WorkerOptions& options, const WorkerId& id,
                                  const std::string& instance) {
    DeskOptions desk;
    desk.worker_id = id.text();
    desk.instance = instance;
    desk.hang_limit = seconds(options.hang_limit);
    desk.unit_limit = seconds(options.unit_limit);
    desk.name = options.name.empty() ? host_name() : options.name;
    desk.host = host_name();
    desk.threads = static_cast<uint32_t>(options.threads);
    desk.ahead = desk.threads;
    desk.memory_bytes = options.memory;
    desk.tags = options.tags;
    return desk;
  }

  // ---- the loop ----

  void post(std::function<void()> event) {
    const std::lock_guard lock(mutex_);
    posted_.push_back(std::move(event));
    wake_.notify_one();
  }

  void run_posted() {
    std::deque<std::function<void()>> events;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, kTick, [this] { return !posted_.empty(); });
      events.swap(posted_);
    }
    for (const auto& event : events) event();
  }

  /// Hands over what is done and gives the rest back, within `time`; asked again, it is hastened.
  void leave(TimePoint now, const std::string& reason, Duration time) {
    const TimePoint by = now + std::max(time - kGoodbye, Duration(0));
    if (!leave_by_) {
      note(LogLevel::info, reason + ": batches that are done are handed over");
      leave_reason_ = reason;
      end_status_ = options_.told_status;
      desk_.leave(reason, true);
    }
    leave_by_ = leave_by_ ? std::min(*leave_by_, by) : by;
  }

  void asked_to_leave(TimePoint now) {
    if (!std::exchange(asked_to_leave_, true)) {
      leave(now, "asked to leave", seconds(options_.grace));
    }
  }

  /// Films that nobody takes are no work: a coordinator that has been away for so long may never
  /// come back, and others render them again.
  bool busy() const {
    if (!renderer_ready_) return true;
    return !desk_.empty() && (desk_.attended() || desk_.in_hand() > desk_.unacknowledged());
  }

  void leave_idle(TimePoint now) {
    note(LogLevel::info,
         fmt::format("no work for {}: leaving", core::format_duration(options_.idle_limit)));
    leave_by_ = now;
    leave_reason_ = "without work";
    desk_.leave(leave_reason_, false);
  }

  void try_to_go(TimePoint now) {
    const bool late = leave_by_ && now >= *leave_by_;
    if (!goodbye_by_ && (desk_.empty() || late)) {
      desk_.give_back_rest(leave_reason_);
      if (desk_.unacknowledged() > 0) {
        note(LogLevel::warning,
             fmt::format("{} films were not acknowledged in time", desk_.unacknowledged()));
      }
      link_.finish();
      goodbye_by_ = now + kGoodbye;
    }
    if (goodbye_by_ && (now >= *goodbye_by_ || !streaming_)) exit_status_ = end_status_;
  }

  // ---- the cloud ----

  void watch_for_preemption() {
    if (!options_.cloud) return;
    note(LogLevel::info,
         fmt::format("watches for notices of pre-emption by {}", name_of(*options_.cloud)));
    preemption_.emplace(*options_.cloud, options_.cloud_endpoint,
                        static_cast<PreemptionWatch::Owner&>(*this));
  }

  void preempted(const Notice& notice) override {
    post([this, notice] {
      const double time = std::max(notice.seconds_left - kLastSeconds, options_.grace);
      leave(Clock::now(),
            fmt::format("pre-empted by {} at {}", name_of(*options_.cloud), notice.at),
            seconds(std::min(time, kLongestLeave)));
    });
  }

  void watch_trouble(const std::string& reason) override {
    post([this, reason] {
      note(LogLevel::warning,
           fmt::format("no notice of pre-emption by {} can be had ({}); trying again",
                       name_of(*options_.cloud), reason));
    });
  }

  // ---- the rendering child ----

  void start_renderer() {
    restart_at_.reset();
    renderer_.reset();
    renderer_started_ = Clock::now();
    renderer_ready_ = false;
    cache_identity_ = folder_identity(options_.cache);
    auto started = RendererProcess::start(
        {options_.renderer, options_.cache, options_.threads, options_.memory, options_.sandbox},
        *this);
    if (!started) {
      note(LogLevel::error, started.error().message);
      exit_status_ = 1;
      return;
    }
    renderer_ = std::move(*started);
    desk_.renderer_started();
  }

  void renderer_says(pipe::FromRenderer message) override {
    post([this, message = std::move(message)]() mutable {
      if (message.has_ready()) {
        renderer_ready_ = true;
        stillbirths_ = 0;
        tell_sandbox(message.ready());
        desk_.renderer_ready(message.ready());
        if (!ever_connected_) connect(Clock::now());
      } else if (message.has_not_ready()) {
        note(LogLevel::error, "this machine cannot render: " + message.not_ready().reason());
        exit_status_ = 1;
      } else {
        desk_.renderer_says(std::move(message), Clock::now());
      }
      if (renderer_) renderer_->heard();
    });
  }

  void renderer_ended(const std::string& reason) override {
    post([this, reason] {
      note(LogLevel::warning, "the rendering process " + reason);
      desk_.renderer_died(reason);
      const TimePoint now = Clock::now();
      if (!renderer_ready_ && ++stillbirths_ >= kMostStillbirths) {
        exit_status_ = 1;
        return;
      }
      const bool healthy = now - renderer_started_ >= kHealthyLife;
      restart_at_ = healthy ? now : now + std::chrono::seconds(1);
      // No time for another child.
      if (leave_by_) desk_.give_back_rest("the rendering process " + reason);
    });
  }

  /// Once: how far the rendering child is held.
  void tell_sandbox(const pipe::Ready& ready) {
    if (std::exchange(sandbox_told_, true)) return;
    if (!ready.sandbox_lacks().empty()) {
      note(LogLevel::warning,
           "the process that renders is not wholly sandboxed: " + ready.sandbox_lacks());
    }
    if (!ready.not_first().empty()) {
      note(LogLevel::warning,
           "the process that renders is not the first to go when this machine runs out of memory "
           "(" +
               ready.not_first() + ")");
    }
  }

  void tell_renderer(pipe::ToRenderer message) override {
    // A sandbox opens the folder that was there when the child began, whatever its name means
    // later.
    if (renderer_ && message.has_job() && folder_identity(options_.cache) != cache_identity_) {
      renderer_->kill("began with another folder as its cache");
    }
    if (renderer_) renderer_->send(std::move(message));
  }

  void kill_renderer(const std::string& reason) override {
    if (renderer_) renderer_->kill(reason);
  }

  // ---- the coordinator ----

  void connect(TimePoint now) {
    connect_at_.reset();
    ever_connected_ = true;
    streaming_ = true;
    link_.open();
    desk_.stream_opened(now);
  }

  void send(v1::WorkerMessage message) override { link_.send(std::move(message)); }

  void stream_says(v1::CoordinatorMessage message) override {
    post([this, message = std::move(message)]() mutable {
      if (message.has_welcome()) {
        if (const uint32_t spoken = message.welcome().protocol(); spoken < farm::kOldestProtocol) {
          note(LogLevel::error,
               fmt::format("the coordinator speaks protocol {}, this worker {} to {}: update it",
                           spoken, farm::kOldestProtocol, farm::kProtocol));
          exit_status_ = 2;
          return;
        }
        backoff_.reset();
        told_trouble_.clear();
        welcomed_ = true;
        unknown_since_.reset();
        name_ = message.welcome().name();
        token_term_ = {message.welcome().token_expires_ms(), message.welcome().token_warn_ms()};
        note(LogLevel::info, fmt::format("working for {} as {}", options_.coordinator.address,
                                         message.welcome().name()));
      }
      desk_.coordinator_says(std::move(message), Clock::now());
    });
  }

  /// There are two with one id, and the other was first.
  void rename() {
    if (auto renewed = id_.renew(); !renewed) {
      note(LogLevel::error, renewed.error().message);
      exit_status_ = 1;
      return;
    }
    desk_.rename(id_.text());
    note(LogLevel::warning,
         "another worker has this one's id (a copied cache, or machine): it takes a new one");
  }

  /// Whether the token's file holds another one than was shown: tokens are changed under workers
  /// that run.
  bool take_new_token() {
    auto token = farm::read_token(options_.coordinator.token_file);
    if (!token || *token == token_) return false;
    token_ = std::move(*token);
    link_.set_token(token_);
    fetcher_.set_token(token_);
    note(LogLevel::info,
         "shows the coordinator the token that " + options_.coordinator.token_file + " holds now");
    return true;
  }

  /// Once a day, in the token's last days.
  void tell_expiry(TimePoint now) {
    if (told_expiry_ && now - *told_expiry_ < kTellExpiryAgain) return;
    const std::string when =
        farm::expiry_warning(token_term_, std::chrono::duration_cast<milliseconds>(
                                              std::chrono::system_clock::now().time_since_epoch())
                                              .count());
    if (when.empty()) return;
    told_expiry_ = now;
    note(LogLevel::warning, "the token of this worker " + when + ": put another one into " +
                                options_.coordinator.token_file);
  }

  /// Who was known once waits for his new token a while, with the films in his hand.
  bool may_hope() {
    if (!welcomed_) return false;
    if (!unknown_since_) unknown_since_ = Clock::now();
    return Clock::now() - *unknown_since_ < kTokenPatience;
  }

  void stream_ended(StreamEnd end, const std::string& reason,
                    std::chrono::milliseconds retry_after) override {
    post([this, end, reason, retry_after] {
      streaming_ = false;
      desk_.stream_closed();
      if (exit_status_) return;
      if (end == StreamEnd::unknown && take_new_token()) {
        connect_at_ = Clock::now();
        return;
      }
      if (end == StreamEnd::refused || (end == StreamEnd::unknown && !may_hope())) {
        note(LogLevel::error, "the coordinator refuses this worker: " + reason);
        exit_status_ = 2;
        return;
      }
      if (end == StreamEnd::id_taken) rename();
      const Duration pause = backoff_.next(std::min<Duration>(retry_after, kLongestPause));
      connect_at_ = Clock::now() + pause;
      std::string trouble = farm::connection_trouble(reason, options_.coordinator);
      if (goodbye_by_ || trouble == told_trouble_) return;
      note(
          LogLevel::warning,
          fmt::format(
              "no connection to {} ({}); {} units in hand, {} films not acknowledged; trying again",
              options_.coordinator.address, trouble, desk_.in_hand(), desk_.unacknowledged()));
      told_trouble_ = std::move(trouble);
    });
  }

  // ---- files ----

  void fetch(uint64_t job, const v1::JobSpec& spec) override { fetcher_.fetch(job, spec); }
  void release(uint64_t job) override { fetcher_.release(job); }
  void doubt(const std::string& file) override { fetcher_.doubt(file); }
  void files_are_there(uint64_t job) override {
    post([this, job] { desk_.files_are_there(job); });
  }
  void files_failed(uint64_t job, const std::string& reason, bool final) override {
    post([this, job, reason, final] { desk_.files_failed(job, reason, final, Clock::now()); });
  }

  void note(LogLevel level, const std::string& text) { note(level, text, {}); }
  void note(LogLevel level, const std::string& text, const farm::LogFields& about) override {
    farm::LogFields fields = about;
    // People know whose log they read; what collects those of many workers does not.
    if (farm::log_format() == farm::LogFormat::json) fields.worker = name_;
    farm::log(level, text, fields);
  }

  const WorkerOptions options_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> posted_;  ///< guarded by mutex_

  // All else belongs to the loop.
  WorkerId id_;
  std::string name_;  ///< as the coordinator has it, once it has said so
  IdleWatch idle_;
  Desk desk_;
  farm::Backoff backoff_{farm::kFirstReconnect, farm::kLongestReconnect};
  bool streaming_ = false;
  bool ever_connected_ = false;
  bool renderer_ready_ = false;
  int stillbirths_ = 0;
  TimePoint renderer_started_;
  FolderIdentity cache_identity_{};  ///< when the rendering child began
  bool sandbox_told_ = false;
  std::string token_;
  farm::TokenTerm token_term_;
  std::optional<TimePoint> told_expiry_;
  bool welcomed_ = false;
  std::optional<TimePoint> unknown_since_;  ///< the coordinator does not know the token any more
  std::string told_trouble_;
  std::optional<TimePoint> connect_at_;
  std::optional<TimePoint> restart_at_;
  std::optional<TimePoint> leave_by_;
  std::string leave_reason_ = "drained";
  int end_status_ = 0;
  bool asked_to_leave_ = false;
  std::optional<TimePoint> goodbye_by_;
  std::optional<int> exit_status_;

  // Last: their threads post to the above.
  std::unique_ptr<RendererProcess> renderer_;
  CoordinatorLink link_;
  AssetFetcher fetcher_;
  std::optional<PreemptionWatch> preemption_;
};

}  // namespace

int work(const WorkerOptions& options, WorkerId id, const std::string& instance,
         std::shared_ptr<grpc::Channel> channel, std::string token, farm::ContentStore& store,
         const volatile std::sig_atomic_t& signals) {
  Worker worker(options, std::move(id), instance, std::move(channel), std::move(token), store);
  return worker.run(signals);
}

}  // namespace hyades::worker
