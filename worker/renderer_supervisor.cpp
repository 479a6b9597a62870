#include "worker/renderer_supervisor.h"

#include <chrono>
#include <cstdint>

#include <sys/stat.h>

namespace hyades::worker {
namespace {

using Clock = std::chrono::steady_clock;
using farm::LogLevel;

/// A child that dies sooner than this is not started again at once.
constexpr std::chrono::seconds kHealthyLife{5};
/// Deaths in a row before a first Ready that make the worker give up.
constexpr int kMostEarlyDeaths = 3;

uint64_t texture_disk(const WorkerOptions& options) {
  constexpr uint64_t kTimes = 4;
  const bool bounded = options.memory > 0 && options.memory <= UINT64_MAX / kTimes;
  return options.texture_disk.value_or(bounded ? options.memory * kTimes : UINT64_MAX);
}

}  // namespace

RendererSupervisor::FolderIdentity RendererSupervisor::folder_identity(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

void RendererSupervisor::start() {
  const WorkerOptions& options = worker_.options;
  restart_at_.reset();
  process_.reset();
  started_ = Clock::now();
  ready_ = false;
  cache_identity_ = folder_identity(files_folder(options));
  auto started = RendererProcess::start({options.renderer, files_folder(options), options.threads,
                                         options.memory, texture_disk(options), options.sandbox},
                                        *this);
  if (!started) {
    worker_.log.note(LogLevel::error, started.error().message);
    worker_.loop.end(1);
    return;
  }
  process_ = std::move(*started);
  worker_.machine.renderer_started();
}

void RendererSupervisor::tick(TimePoint now) {
  if (restart_at_ && now >= *restart_at_ && !last_) start();
}

void RendererSupervisor::tell(pipe::ToRenderer message) {
  // A sandbox opens the folder that was there when the child began, whatever its name means
  // later.
  if (process_ && message.has_job() &&
      folder_identity(files_folder(worker_.options)) != cache_identity_) {
    process_->kill("began with another folder as its cache");
  }
  if (process_) process_->send(std::move(message));
}

void RendererSupervisor::kill(const std::string& reason) {
  if (process_) process_->kill(reason);
}

void RendererSupervisor::renderer_says(pipe::FromRenderer message) {
  worker_.loop.post([this, message = std::move(message)] {
    switch (message.message_case()) {
      case pipe::FromRenderer::kReady:
        ready_ = true;
        early_deaths_ = 0;
        tell_sandbox(message.ready());
        worker_.machine.renderer_ready(message.ready());
        break;
      case pipe::FromRenderer::kNotReady:
        worker_.log.note(LogLevel::error,
                         "this machine cannot render: " + message.not_ready().reason());
        worker_.loop.end(1);
        break;
      case pipe::FromRenderer::kStarted:
      case pipe::FromRenderer::kFilm:
      case pipe::FromRenderer::kFailed:
      case pipe::FromRenderer::kReturned:
      case pipe::FromRenderer::kProgress:
      case pipe::FromRenderer::MESSAGE_NOT_SET:
        worker_.machine.renderer_says(message);
        break;
    }
    if (process_) process_->heard();
  });
}

void RendererSupervisor::renderer_ended(const std::string& reason) {
  worker_.loop.post([this, reason] { ended(reason); });
}

void RendererSupervisor::ended(const std::string& reason) {
  worker_.log.note(LogLevel::warning, "the rendering process " + reason);
  worker_.machine.renderer_died(reason);
  const TimePoint now = Clock::now();
  if (!ready_ && ++early_deaths_ >= kMostEarlyDeaths) {
    worker_.loop.end(1);
    return;
  }
  const bool healthy = now - started_ >= kHealthyLife;
  restart_at_ = healthy ? now : now + std::chrono::seconds(1);
  if (last_) worker_.machine.give_back_rest("the rendering process " + reason);
}

/// Once: how far the rendering child is held.
void RendererSupervisor::tell_sandbox(const pipe::Ready& ready) {
  if (std::exchange(sandbox_told_, true)) return;
  if (!ready.sandbox_lacks().empty()) {
    worker_.log.note(LogLevel::warning,
                     "the process that renders is not wholly sandboxed: " + ready.sandbox_lacks());
  }
  if (!ready.not_first().empty()) {
    worker_.log.note(LogLevel::warning,
                     "the process that renders is not the first to go when this machine runs out "
                     "of memory (" +
                         ready.not_first() + ")");
  }
}

}  // namespace hyades::worker
