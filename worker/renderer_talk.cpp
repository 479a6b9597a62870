#include "worker/renderer_talk.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/hash.h"
#include "farm/wire.h"

namespace hyades::worker {
namespace {

/// Notes of a film: a renderer writes 8.
constexpr int kMostNotes = 16;
/// Units in work: as many as a worker may have threads.
constexpr int kMostUnits = 4096;
/// Bytes of what it says of itself.
constexpr size_t kMostWords = 1000;

const char* wrong_film(const pipe::UnitFilm& film) {
  if (film.film().empty()) return "sent a film without bytes";
  if (film.batches() == 0) return "sent a film of no batches";
  if (film.digest().size() != sizeof(core::Sha256)) return "sent a film without a digest";
  const bool long_notes = std::any_of(film.notes().begin(), film.notes().end(),
                                      [](const auto& n) { return n.size() > farm::kMaxTextBytes; });
  return film.notes_size() > kMostNotes || long_notes ? "sent a film with too many notes" : nullptr;
}

const char* wrong_greeting(const pipe::FromRenderer& message) {
  if (message.has_not_ready()) return nullptr;
  if (!message.has_ready()) return "spoke before it was ready";
  const pipe::Ready& ready = message.ready();
  const bool long_words = ready.worker_class().size() > kMostWords ||
                          ready.portable_class().size() > kMostWords ||
                          ready.build().size() > kMostWords || ready.worker_class().empty();
  return long_words ? "did not say what it is" : nullptr;
}

const char* wrong_news(const pipe::FromRenderer& message) {
  switch (message.message_case()) {
    case pipe::FromRenderer::kReady:
    case pipe::FromRenderer::kNotReady:
      return "said twice whether it is ready";
    case pipe::FromRenderer::kFilm:
      return wrong_film(message.film());
    case pipe::FromRenderer::kProgress:
      return message.progress().units_size() > kMostUnits ? "told of too many units" : nullptr;
    case pipe::FromRenderer::kStarted:
    case pipe::FromRenderer::kFailed:
    case pipe::FromRenderer::kReturned:
      return nullptr;
    case pipe::FromRenderer::MESSAGE_NOT_SET:
      break;
  }
  return "said nothing that is known";
}

}  // namespace

pipe::PipeLimits renderer_limits() {
  return {static_cast<uint32_t>(farm::kMaxWorkerTalkBytes),
          static_cast<uint32_t>(farm::kMaxResultBytes)};
}

core::Status RendererTalk::hear(pipe::FromRenderer& message, std::string load) {
  if (message.has_film()) {
    message.mutable_film()->set_film(std::move(load));
  } else if (!load.empty()) {
    return core::Error{"sent bytes that are no film"};
  }
  const char* wrong = std::exchange(greeted_, true) ? wrong_news(message) : wrong_greeting(message);
  if (wrong != nullptr) return core::Error{wrong};
  return {};
}

}  // namespace hyades::worker
