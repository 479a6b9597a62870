#include "tests/bench/many_workers/light_worker.h"

#include "core/base/random_id.h"
#include "core/film/film_codec.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "tests/coordinator/services/fake_films.h"

namespace hyades::bench {
namespace {

double milliseconds_since(Timer::Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Timer::Clock::now() - begin).count();
}

std::string key(const v1::LeasedUnit& leased) {
  v1::Unit unit = leased.unit();
  unit.clear_proof();
  return std::to_string(leased.job()) + "/" + unit.SerializeAsString();
}

}  // namespace

LightWorker::LightWorker(Crowd& crowd, std::shared_ptr<grpc::Channel> channel,
                         const std::string& token, int number)
    : crowd_(crowd), stub_(v1::Work::NewStub(std::move(channel))) {
  farm::prepare(context_, token, std::chrono::milliseconds(0));
  stub_->async()->Attend(&context_, this);
  v1::WorkerMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol(farm::kProtocol);
  hello.set_worker_id(*core::random_id());
  hello.set_instance(*core::random_id());
  hello.set_name("light/" + std::to_string(number));
  hello.set_host("bench");
  hello.set_worker_class(std::string(64, 'c'));
  hello.set_threads(1);
  hello.set_want(1);
  wished_ = Clock::now();
  send(std::move(message));
  StartRead(&incoming_);
  StartCall();
}

void LightWorker::send(v1::WorkerMessage message) {
  const std::lock_guard lock(mutex_);
  if (done_) return;
  outgoing_.push_back(std::move(message));
  if (!writing_) write_next();
}

void LightWorker::write_next() {
  writing_ = !outgoing_.empty();
  if (writing_) StartWrite(&outgoing_.front());
}

void LightWorker::OnWriteDone(bool ok) {
  const std::lock_guard lock(mutex_);
  outgoing_.pop_front();
  if (ok) {
    write_next();
  } else {
    writing_ = true;  // nothing is written any more
  }
}

void LightWorker::OnReadDone(bool ok) {
  if (!ok) return;
  const v1::CoordinatorMessage& message = incoming_;
  if (message.has_welcome()) {
    ++crowd_.welcomed;
    beat_every_ = std::chrono::milliseconds(message.welcome().heartbeat_ms());
    beat();
  } else if (message.has_lease()) {
    on_lease(message.lease());
  } else if (message.has_acknowledge()) {
    const std::string unit = key(message.acknowledge().unit());
    const std::lock_guard lock(mutex_);
    if (const auto sent = delivered_.find(unit); sent != delivered_.end()) {
      crowd_.acknowledgement.add(milliseconds_since(sent->second));
      delivered_.erase(sent);
    }
    in_hand_.erase(unit);
    ++crowd_.acknowledged;
  } else if (message.has_rejected()) {
    ++crowd_.rejected;
    const std::lock_guard lock(mutex_);
    if (trouble_.empty()) trouble_ = message.rejected().text();
    in_hand_.erase(key(message.rejected().unit()));
  }
  StartRead(&incoming_);
}

void LightWorker::on_lease(const v1::Lease& lease) {
  crowd_.lease.add(milliseconds_since(wished_));
  for (const v1::Unit& unit : lease.units()) {
    v1::LeasedUnit leased;
    *leased.mutable_lease() = lease.lease();
    leased.set_job(lease.job());
    *leased.mutable_unit() = unit;
    {
      const std::lock_guard lock(mutex_);
      in_hand_[key(leased)] = lease.lease();
    }
    const auto what = farm::from_wire(unit);
    uint64_t samples = 0;
    for (uint32_t b = what->batches.first; b < what->batches.end(); ++b) {
      samples += core::samples_in_batch(b, crowd_.samples);
    }
    const double seconds = static_cast<double>(samples) * static_cast<double>(what->tile.area()) *
                           crowd_.seconds_per_sample;
    crowd_.timer.at(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(seconds)),
                    [this, leased, seconds] { finish(leased, seconds); });
  }
}

void LightWorker::finish(const v1::LeasedUnit& leased, double seconds) {
  if (done_) return;
  const auto unit = farm::from_wire(leased.unit());
  const core::Film film = coordinator::fake_film(*unit, crowd_.samples, crowd_.layout);
  const std::vector<std::byte> bytes = core::encode_film(film);
  v1::WorkerMessage message;
  v1::UnitResult& result = *message.mutable_result();
  *result.mutable_lease() = leased.lease();
  result.set_job(leased.job());
  *result.mutable_unit() = leased.unit();
  result.set_film(bytes.data(), bytes.size());
  result.set_digest(farm::to_wire(*farm::digest_from_hex(film.digest())));
  result.set_render_ns(static_cast<uint64_t>(seconds * 1e9));
  result.set_want(1);
  ++crowd_.units;
  {
    const std::lock_guard lock(mutex_);
    delivered_[key(leased)] = wished_ = Clock::now();
  }
  send(std::move(message));
}

void LightWorker::beat() {
  if (done_) return;
  v1::WorkerMessage message;
  v1::Heartbeat& heartbeat = *message.mutable_heartbeat();
  {
    const std::lock_guard lock(mutex_);
    heartbeat.set_number(++beats_);
    for (const auto& [unit, lease] : in_hand_) {
      v1::LeaseProgress& progress = *heartbeat.add_leases();
      *progress.mutable_lease() = lease;
      progress.set_samples_done(beats_);
      progress.set_stage(v1::LeaseProgress::STAGE_RENDERING);
    }
  }
  send(std::move(message));
  crowd_.beats.at(Clock::now() + beat_every_, [this] { beat(); });
}

void LightWorker::OnDone(const grpc::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    if (!status.ok()) trouble_ = status.error_message();
  }
  ++crowd_.ended;
  done_ = true;
}

}  // namespace hyades::bench
