// Messages of workers and of whoever gives a film: what parses goes through what makes structs of
// the core of it, and what it makes must be the same on the way back. The first byte chooses.
// tests/coordinator/hostile sends such messages to a whole coordinator.

#include <cstdlib>

#include "core/film/film_codec.h"
#include "farm/wire.h"
#include "hyades/v1/jobs.pb.h"
#include "hyades/v1/work.pb.h"
#include "tests/fuzz/fuzz.h"

namespace hyades::fuzz {
namespace {

constexpr core::FilmLimits kSmallFilms{uint64_t{16} << 20U};

void try_unit(const v1::Unit& wire) {
  const auto unit = farm::from_wire(wire);
  if (!unit) return;
  const auto back = farm::from_wire(farm::to_wire(*unit));
  if (!back ||
      farm::to_wire(*back).SerializeAsString() != farm::to_wire(*unit).SerializeAsString()) {
    std::abort();
  }
}

bool try_worker_message(const std::string& bytes) {
  v1::WorkerMessage message;
  if (!message.ParseFromString(bytes)) return false;
  (void)farm::wire_text(message.hello().name());
  for (const v1::LeasedUnit& held : message.hello().in_hand()) try_unit(held.unit());
  for (const v1::LeasedUnit& held : message.returned().units()) try_unit(held.unit());
  try_unit(message.failure().unit().unit());
  try_unit(message.result().unit());
  (void)farm::digest_from_wire(message.result().digest());
  const std::string& film = message.result().film();
  (void)core::decode_film(std::as_bytes(std::span(film)), kSmallFilms);
  return true;
}

bool try_film_header(const std::string& bytes) {
  v1::FilmHeader header;
  return header.ParseFromString(bytes) && farm::from_wire(header).ok();
}

}  // namespace

std::vector<std::string> seeds() {
  v1::Unit unit = farm::to_wire(core::Unit{3, {0, 0, 16, 8}, {2, 4}});
  v1::WorkerMessage result;
  *result.mutable_result()->mutable_unit() = unit;
  result.mutable_result()->set_film("no film");
  result.mutable_result()->set_digest(std::string(32, 'd'));
  v1::WorkerMessage hello;
  hello.mutable_hello()->set_name("host/1");
  *hello.mutable_hello()->add_in_hand()->mutable_unit() = unit;
  v1::WorkerMessage failure;
  *failure.mutable_failure()->mutable_unit()->mutable_unit() = unit;
  core::FilmInfo info{"job", std::string(64, 'a'), 1, 8, 6, {0, 0, 8, 6}, 64, "class", "build", {}};
  return {"w" + result.SerializeAsString(), "w" + hello.SerializeAsString(),
          "w" + failure.SerializeAsString(), "f" + farm::to_wire(info).SerializeAsString()};
}

bool try_input(std::string_view input) {
  if (input.empty()) return false;
  const std::string bytes(input.substr(1));
  return input.front() == 'f' ? try_film_header(bytes) : try_worker_message(bytes);
}

}  // namespace hyades::fuzz
