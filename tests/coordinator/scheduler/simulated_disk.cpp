#include "tests/coordinator/scheduler/simulated_disk.h"

#include <utility>

#include "core/base/hash.h"
#include "core/base/overloaded.h"
#include "core/film/film_codec.h"

namespace hyades::coordinator {
namespace {

constexpr const char* kFolder = "films";

core::FilmLayout layout_of(const JobPlan& plan) {
  return core::make_film_layout({.depth = true, .splats = plan.whole_frames});
}

}  // namespace

LogContents SimulatedDisk::open() {
  FilmLogOptions options;
  options.files = &files_;
  options.threaded = false;
  options.salt = salt_;
  options.segment_bytes = 20'000;
  options.max_pending_bytes = 30'000;
  auto log = FilmLog::open(kFolder, "job", options);
  if (!log) throw "the film log does not open: " + log.error().message;
  LogFilter filter{
      {plan_.frames.begin(), plan_.frames.end()}, plan_.region, samples(), {}, false, true};
  auto contents = read_log(**log, filter);
  if (!contents) throw "the film log cannot be read: " + contents.error().message;
  log_ = std::move(*log);
  aside_ = std::make_unique<FilmsAside>(files_, kFolder, plan_.region);
  if (const auto gone = aside_->remove_left(); !gone)
    throw "films stay aside: " + gone.error().message;
  for (const auto& [frame, places] : contents->places) aside_->leave(*log_, frame, places);
  if (contents->empty) {
    const auto cut = log_->append(encode_cut({plan_.region, plan_.tile_size, samples()}));
    if (!cut) throw "the film log takes nothing: " + cut.error().message;
  }
  return std::move(*contents);
}

void SimulatedDisk::die(bool power, std::mt19937& random) {
  log_.reset();
  aside_.reset();
  if (power) {
    files_.crash(random);
  } else {
    files_.kill();
  }
}

core::Result<uint64_t> SimulatedDisk::append(const Record& record, uint8_t mark) {
  using Bytes = std::vector<std::byte>;
  return log_->append(std::visit(
      core::Overloaded{
          [&](const UnitRecord& unit) {
            const core::Film film = film_of(unit.accepted.unit, mark);
            return encode_delivered(unit.accepted, {}, core::encode_film(film));
          },
          [&](const FrameFinishedRecord& done) {
            return encode_finished(done.frame, {{}, plan_.region});
          },
          [](const FrameFailedRecord&) -> Bytes { throw "a failed frame is not in the film log"; },
          [](const FrameRestartedRecord& restarted) { return encode(restarted); },
          [](const TileVoidedRecord& voided) { return encode(voided); },
          [](const DisputeRecord& dispute) { return encode(dispute); },
          [](const DivergentWorkerRecord&) -> Bytes {
            throw "a divergent worker is not in the film log";
          },
      },
      record));
}

core::Status SimulatedDisk::compact(uint64_t through, const std::vector<int32_t>& finished,
                                    const std::map<int32_t, Frame>& frames) {
  std::map<int32_t, std::vector<RecordPlace>> places;
  const auto write = [&](const FilmLog::Sink& sink) -> core::Status {
    const CutRecord cut{plan_.region, plan_.tile_size, samples()};
    core::Status status = sink(encode_cut(cut));
    for (const int32_t frame : finished) {
      if (status) status = sink(encode_finished(frame, {{}, plan_.region}));
    }
    for (const auto& [number, frame] : frames) {
      if (!status) break;
      if (!aside_->contains(number)) {
        status = write_film(number, {}, *frame.film, cut, frame.worker_class, sink);
        continue;
      }
      const bool in_log = !aside_->frames().at(number).places.empty();
      status = aside_->copy(number, [&](std::span<const std::byte> record) {
        const core::Status done = sink(record);
        if (done && in_log) places[number].push_back(log_->place());
        return done;
      });
    }
    return status;
  };
  return log_->compact(through, write, [&] {
    for (auto& [number, records] : places) aside_->move(number, std::move(records));
  });
}

core::Status SimulatedDisk::set_aside(int32_t frame, const core::Film& film,
                                      const std::string& worker_class) {
  return aside_->put(frame, film, plan_.tile_size, {}, worker_class);
}

std::string SimulatedDisk::digest_aside(int32_t frame) const {
  const auto film = aside_->read(frame);
  if (!film) throw "a film that is in the log cannot be read: " + film.error().message;
  return *film ? (*film)->digest() : blank().digest();
}

std::string SimulatedDisk::void_aside(const TileVoidedRecord& voided) {
  const auto film = aside_->read(voided.frame);
  aside_->add(voided.frame, encode(voided));
  if (!film) return "";
  core::Film whole = *film ? std::move(**film) : blank();
  whole.erase(voided.tile);
  return whole.digest();
}

core::Result<core::Film> SimulatedDisk::fetch(int32_t frame) {
  auto film = aside_->read(frame);
  aside_->remove(frame);
  if (!film) return film.error();
  return *film ? std::move(**film) : blank();
}

void SimulatedDisk::damage_aside(int32_t frame) {
  const std::string start = std::string(kFolder) + "/" + std::to_string(frame) + ".";
  for (const std::string& path : files_.paths()) {
    if (!path.starts_with(start)) continue;
    std::vector<std::byte>& bytes = files_.bytes(path);
    bytes.resize(bytes.size() / 2);
  }
}

uint64_t SimulatedDisk::used() {
  uint64_t used = 0;
  for (const std::string& path : files_.paths()) used += files_.bytes(path).size();
  return used;
}

core::Film SimulatedDisk::blank() const { return {layout_of(plan_), plan_.region}; }

core::Film SimulatedDisk::film_of(const core::Unit& unit, uint8_t mark) const {
  core::Film film(layout_of(plan_), unit.tile, plan_.region);
  std::vector<core::PixelSplat> splats;
  const auto channels = static_cast<size_t>(film.layout().deposited);
  std::vector<float> values(static_cast<size_t>(unit.tile.area()) * channels);
  for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
    size_t i = 0;
    for (int y = unit.tile.y0; y < unit.tile.y1; ++y) {
      for (int x = unit.tile.x0; x < unit.tile.x1; ++x) {
        const uint64_t pixel = (static_cast<uint64_t>(uint32_t(x)) << 32U) | uint32_t(y);
        const uint64_t h = core::hash_combine(
            core::hash_combine(static_cast<uint64_t>(unit.frame) << 32U | b, pixel), mark);
        for (size_t c = 0; c < channels; ++c) {
          values[i++] = static_cast<float>((h >> (3 * c)) & 0xffffU) * 0.001F;
        }
        if (!plan_.whole_frames) continue;
        const auto area = static_cast<uint64_t>(plan_.region.area());
        splats.push_back({static_cast<uint32_t>(h % area), {values[i - 1], 1.0F, values[i - 2]}});
      }
    }
    film.deposit(unit.tile, b, core::kBatchSamples, values);
  }
  if (plan_.whole_frames) film.deposit_splats(std::move(splats));
  return film;
}

core::Film SimulatedDisk::oracle(int32_t frame) const {
  return film_of({frame, plan_.region, {0, plan_.batches}}, 0);
}

}  // namespace hyades::coordinator
