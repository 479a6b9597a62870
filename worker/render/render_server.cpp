#include "worker/render/render_server.h"

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/base/fp_mode.h"
#include "core/base/text.h"
#include "core/film/film_codec.h"
#include "farm/wire.h"
#include "worker/render/process_memory.h"

namespace hyades::worker {
namespace {

constexpr auto kProgressEvery = std::chrono::milliseconds(500);

/// Runs `body`, which returns a Result; what it throws becomes the error.
template <class Body>
auto guarded(const Body& body) -> decltype(body()) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return core::Error{"out of memory (--memory of the worker)"};
  } catch (const std::exception& e) {
    return core::Error{e.what()};
  }
}

core::Status check(const core::Unit& unit, const ShelvedFrame& frame) {
  if (frame.window.contains(unit.tile) && unit.batches.end() <= core::batch_count(frame.samples)) {
    return {};
  }
  return core::Error{"the unit is not one of this job"};
}

}  // namespace

RenderServer::RenderServer(pipe::MessagePipe& parent, SceneShelf& shelf, int threads)
    : parent_(parent), shelf_(shelf) {
  for (int i = 1; i <= threads; ++i) threads_.emplace_back([this, i] { render_loop(i); });
  threads_.emplace_back([this] { load_loop(); });
  threads_.emplace_back([this] { progress_loop(); });
}

void RenderServer::run() {
  pipe::ToRenderer message;
  std::string load;
  for (;;) {
    const auto more = parent_.receive(message, load);
    if (!more || !*more) return;
    switch (message.message_case()) {
      case pipe::ToRenderer::kJob:
        shelf_.add_job(message.job().job(), message.job().spec());
        break;
      case pipe::ToRenderer::kUnit:
        add(message.unit());
        break;
      case pipe::ToRenderer::kStop:
        stop(message.stop().token(), false);
        break;
      case pipe::ToRenderer::kHandOver:
        hand_over();
        break;
      case pipe::ToRenderer::kForget:
        shelf_.forget_job(message.forget().job());
        break;
      case pipe::ToRenderer::MESSAGE_NOT_SET:
        break;
    }
  }
}

void RenderServer::add(const pipe::UnitToRender& message) {
  auto unit = farm::from_wire(message.unit());
  if (!unit) {
    say_failed(message.token(), unit.error().message);
    return;
  }
  auto task = std::make_shared<Task>();
  task->token = message.token();
  task->job = message.job();
  task->unit = *unit;
  const core::MutexLock lock(mutex_);
  task->frame = shelf_.find(task->job, unit->frame);
  task->state = task->frame ? Task::State::ready : Task::State::waiting;
  tasks_[task->token] = task;
  (task->frame ? render_wake_ : load_wake_).notify_one();
}

void RenderServer::stop(uint64_t token, bool keep_batches) {
  {
    const core::MutexLock lock(mutex_);
    const auto found = tasks_.find(token);
    if (found == tasks_.end()) return;
    Task& task = *found->second;
    task.keep_batches = keep_batches;
    task.stop = true;
    if (task.state == Task::State::rendering) return;  // its thread answers
    tasks_.erase(found);
  }
  pipe::FromRenderer returned;
  returned.mutable_returned()->set_token(token);
  send(returned);
}

void RenderServer::hand_over() {
  std::vector<uint64_t> tokens;
  {
    const core::MutexLock lock(mutex_);
    for (const auto& [token, task] : tasks_) tokens.push_back(token);
  }
  for (const uint64_t token : tokens) stop(token, true);
}

/// Waits for a task that is `from`; it is `to` from then on.
RenderServer::TaskPtr RenderServer::take(Task::State from, Task::State to, core::CondVar& wake) {
  const core::MutexLock lock(mutex_);
  for (;;) {
    for (const auto& [token, task] : tasks_) {
      if (task->state != from) continue;
      task->state = to;
      return task;
    }
    wake.wait(mutex_);
  }
}

void RenderServer::render_loop(int thread) {
  const core::FpMode mode;
  for (;;) {
    const TaskPtr task = take(Task::State::ready, Task::State::rendering, render_wake_);
    pipe::FromRenderer started;
    started.mutable_started()->set_token(task->token);
    send(started);
    render(*task, thread);
    const core::MutexLock lock(mutex_);
    tasks_.erase(task->token);
  }
}

void RenderServer::render(Task& task, int thread) {
  const auto begin = std::chrono::steady_clock::now();
  pipe::FromRenderer message;
  std::string film_bytes;
  const core::Status done = guarded([&]() -> core::Status {
    if (auto checked = check(task.unit, *task.frame); !checked) return checked;
    const core::RenderedUnit unit =
        task.frame->renderer.render(task.unit, &task.stop, &task.batches_done, &task.samples_done);
    const uint32_t batches = unit.stopped ? task.batches_done.load() : task.unit.batches.count;
    bool keep = !unit.stopped;
    if (unit.stopped) {
      const core::MutexLock lock(mutex_);
      keep = task.keep_batches && batches > 0;
    }
    if (!keep) {
      message.mutable_returned()->set_token(task.token);
      return {};
    }
    pipe::UnitFilm& film = *message.mutable_film();
    film.set_token(task.token);
    film.set_batches(batches);
    const auto bytes = core::encode_film(unit.film);
    if (bytes.size() > farm::kMaxResultBytes) {
      return core::Error{fmt::format("its film is too large to be sent: {}, at most {}",
                                     core::format_bytes(bytes.size()),
                                     core::format_bytes(farm::kMaxResultBytes))};
    }
    film_bytes.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto digest = farm::digest_from_hex(unit.film.digest());
    if (!digest) return digest.error();
    film.set_digest(farm::to_wire(*digest));
    film.set_render_ns(static_cast<uint64_t>((std::chrono::steady_clock::now() - begin).count()));
    film.set_thread(static_cast<uint32_t>(thread));
    film.set_samples(unit.counters.samples);
    film.set_rays(unit.counters.rays);
    film.set_bad_samples(unit.counters.bad_samples);
    for (const core::BadSample& bad : unit.counters.examples) {
      film.add_notes(farm::wire_text(
          fmt::format("a sample is {} and counts as black; to see why: hyades replay {} --frame "
                      "{} --pixel {},{} --sample {}",
                      core::bad_sample_words(), task.frame->document, task.unit.frame, bad.pixel.x,
                      bad.pixel.y, bad.sample)));
    }
    return {};
  });
  if (done) {
    send(message, film_bytes);
  } else {
    say_failed(task.token, done.error().message);
  }
}

void RenderServer::load_loop() {
  const core::FpMode mode;
  for (;;) {
    const TaskPtr first = take(Task::State::waiting, Task::State::loading, load_wake_);
    pipe::FromRenderer started;
    started.mutable_started()->set_token(first->token);
    started.mutable_started()->set_loading(true);
    send(started);
    const auto frame = guarded([&] { return shelf_.load(first->job, first->unit.frame); });
    std::vector<uint64_t> failed;
    {
      const core::MutexLock lock(mutex_);
      for (auto it = tasks_.begin(); it != tasks_.end();) {
        Task& task = *it->second;
        const bool same = task.job == first->job && task.unit.frame == first->unit.frame &&
                          task.state <= Task::State::loading;
        if (same && frame) {
          task.frame = *frame;
          task.state = Task::State::ready;
        } else if (same) {
          failed.push_back(it->first);
          it = tasks_.erase(it);
          continue;
        }
        ++it;
      }
      render_wake_.notify_all();
    }
    // What this process may not remove, its worker does.
    const std::set<std::string> damaged = shelf_.take_damaged();
    for (const uint64_t token : failed) say_failed(token, frame.error().message, damaged);
  }
}

void RenderServer::progress_loop() {
  for (;;) {
    std::this_thread::sleep_for(kProgressEvery);
    pipe::FromRenderer message;
    {
      const core::MutexLock lock(mutex_);
      if (tasks_.empty()) continue;
      for (const auto& [token, task] : tasks_) {
        if (task->state != Task::State::rendering) continue;
        auto& unit = *message.mutable_progress()->add_units();
        unit.set_token(token);
        unit.set_samples_done(task->samples_done.load(std::memory_order_relaxed));
      }
    }
    message.mutable_progress()->set_memory_bytes(resident_memory());
    send(message);
  }
}

namespace {

/// Mistakes of a job are a line each; who is told shows one.
std::string in_one_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  for (size_t end = 0; (end = text.find('\n', end)) != std::string::npos;)
    text.replace(end, 1, "; ");
  return text;
}

}  // namespace

void RenderServer::say_failed(uint64_t token, const std::string& reason,
                              const std::set<std::string>& damaged) {
  pipe::FromRenderer message;
  message.mutable_failed()->set_token(token);
  message.mutable_failed()->set_reason(farm::wire_text(in_one_line(reason)));
  for (const std::string& name : damaged) message.mutable_failed()->add_damaged(name);
  send(message);
}

void RenderServer::send(const pipe::FromRenderer& message, const std::string& film) {
  // Without its parent this process has nothing to do.
  if (!parent_.send(message, film)) ::_exit(1);
}

}  // namespace hyades::worker
