#include "tests/worker/process/fake_coordinator.h"

#include <set>
#include <span>
#include <tuple>
#include <utility>

#include <grpcpp/grpcpp.h>

#include "core/base/hash.h"
#include "core/film/film_codec.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "hyades/v1/work.grpc.pb.h"

namespace hyades::worker {
namespace {

constexpr uint64_t kJob = 3;
using Key = std::tuple<int, int, int, uint32_t>;

Key key_of(const core::Unit& u) { return {u.frame, u.tile.x0, u.tile.y0, u.batches.first}; }

}  // namespace

struct FakeCoordinator::Books {
  struct Leased {
    core::Unit unit;
    const void* holder = nullptr;  // the stream of the worker
  };

  FakeCoordinator* owner = nullptr;
  Job job;
  int port = 0;
  std::unique_ptr<WorkService> work;
  std::unique_ptr<AssetService> assets;
  std::unique_ptr<grpc::Server> server;

  mutable std::mutex mutex;
  std::condition_variable changed;
  // Guarded by mutex.
  Seen seen;
  std::map<Key, Leased> leased;
  std::set<Key> held;
  uint64_t next_lease = 1;
};

class FakeCoordinator::AssetService : public v1::Assets::Service {
 public:
  explicit AssetService(Books& books) : books_(books) {}
  grpc::Status Download(grpc::ServerContext* /*context*/, const v1::DownloadRequest* request,
                        grpc::ServerWriter<v1::Chunk>* writer) override {
    {
      const std::lock_guard lock(books_.mutex);
      ++books_.seen.downloads;
    }
    for (const auto& [path, bytes] : books_.job.files) {
      if (farm::to_wire(core::sha256(bytes)) != request->sha256()) continue;
      constexpr size_t kPiece = 100'000;
      for (size_t at = request->offset(); at < bytes.size(); at += kPiece) {
        v1::Chunk chunk;
        chunk.set_offset(at);
        chunk.set_data(bytes.substr(at, kPiece));
        writer->Write(chunk);
      }
      return grpc::Status::OK;
    }
    return {grpc::StatusCode::NOT_FOUND, "no such file"};
  }

 private:
  Books& books_;
};

class FakeCoordinator::WorkService : public v1::Work::Service {
 public:
  explicit WorkService(Books& books) : books_(books) {}

  using Stream = grpc::ServerReaderWriter<v1::CoordinatorMessage, v1::WorkerMessage>;
  grpc::Status Attend(grpc::ServerContext* context, Stream* stream) override {
    const std::string& token = books_.owner->token;
    const auto shown = context->client_metadata().find(farm::kTokenKey);
    if (!token.empty() && (shown == context->client_metadata().end() ||
                           shown->second != grpc::string_ref("Bearer " + token))) {
      return {grpc::StatusCode::UNAUTHENTICATED, "this is not a token of this coordinator"};
    }
    v1::WorkerMessage message;
    uint32_t want = 0;
    bool leaving = false;
    while (stream->Read(&message)) {
      const std::lock_guard lock(books_.mutex);
      if (message.has_hello()) {
        books_.seen.hellos.push_back(message.hello());
        if (books_.owner->silent) {
          books_.changed.notify_all();
          continue;
        }
        if (books_.owner->twins > 0) {
          --books_.owner->twins;
          books_.changed.notify_all();
          return {grpc::StatusCode::ALREADY_EXISTS, "a worker called other works under this id"};
        }
        greet(stream, message.hello());
        want += message.hello().want();
      } else if (message.has_request()) {
        want += message.request().units();
      } else if (message.has_result()) {
        want += message.result().want();
        judge(stream, message.result());
      } else if (message.has_failure()) {
        want += message.failure().want();
        books_.seen.failures.push_back(message.failure());
        if (books_.owner->answer_failures) give_back(message.failure().unit());
      } else if (message.has_returned()) {
        books_.seen.returned += static_cast<size_t>(message.returned().units_size());
        for (const auto& unit : message.returned().units()) give_back(unit);
      } else if (message.has_heartbeat()) {
        v1::CoordinatorMessage echo;
        echo.mutable_echo()->set_number(message.heartbeat().number());
        stream->Write(echo);
      } else if (message.has_leaving()) {
        books_.seen.leavings.push_back(message.leaving());
        leaving = true;
      }
      if (leaving) want = 0;
      while (want > 0 && !books_.job.units.empty()) {
        lease(stream, books_.job.units.front());
        books_.job.units.pop_front();
        --want;
      }
      books_.changed.notify_all();
    }
    if (leaving) take_back(stream);
    return grpc::Status::OK;
  }

 private:
  void greet(Stream* stream, const v1::Hello& hello) {
    v1::CoordinatorMessage message;
    message.mutable_welcome()->set_protocol(books_.owner->protocol);
    message.mutable_welcome()->set_heartbeat_ms(200);
    message.mutable_welcome()->set_lease_ms(books_.owner->lease_ms);
    message.mutable_welcome()->set_name(hello.name());
    stream->Write(message);
    v1::JobBrief& brief = *message.mutable_job();
    brief.set_job(kJob);
    brief.mutable_spec()->set_document("job.yaml");
    for (const auto& [path, bytes] : books_.job.files) {
      v1::JobFile& file = *brief.mutable_spec()->add_files();
      file.set_path(path);
      file.set_sha256(farm::to_wire(core::sha256(bytes)));
      file.set_size(bytes.size());
    }
    stream->Write(message);
    for (const v1::LeasedUnit& unit : hello.in_hand()) {
      const core::Unit u = *farm::from_wire(unit.unit());
      if (!books_.held.contains(key_of(u))) lease(stream, u, true);
      std::erase_if(books_.job.units, [&](const core::Unit& other) { return other == u; });
    }
  }

  void lease(Stream* stream, const core::Unit& unit, bool adopted = false) {
    v1::CoordinatorMessage message;
    message.mutable_lease()->mutable_lease()->set_number(books_.next_lease++);
    message.mutable_lease()->set_job(kJob);
    *message.mutable_lease()->add_units() = farm::to_wire(unit);
    message.mutable_lease()->set_adopted(adopted);
    stream->Write(message);
    books_.leased[key_of(unit)] = {unit, stream};
  }

  /// A lease may have crossed the last words of who leaves.
  void take_back(const Stream* stream) {
    const std::lock_guard lock(books_.mutex);
    for (auto leased = books_.leased.begin(); leased != books_.leased.end();) {
      const bool theirs = leased->second.holder == stream;
      if (theirs) books_.job.units.push_back(leased->second.unit);
      leased = theirs ? books_.leased.erase(leased) : std::next(leased);
    }
    books_.changed.notify_all();
  }

  void give_back(const v1::LeasedUnit& unit) {
    const core::Unit u = *farm::from_wire(unit.unit());
    if (books_.leased.erase(key_of(u)) > 0) books_.job.units.push_back(u);
  }

  void judge(Stream* stream, const v1::UnitResult& result) {
    const core::Unit unit = *farm::from_wire(result.unit());
    const auto film = core::decode_film(std::as_bytes(std::span(result.film())));
    if (!film) {
      books_.seen.damage.push_back(film.error().message);
      return;
    }
    if (farm::to_wire(*farm::digest_from_hex(film->digest())) != result.digest()) {
      books_.seen.damage.emplace_back("the digest is another one");
    }
    if (!books_.held.insert(key_of(unit)).second) {
      ++books_.seen.doubles;
      books_.leased.erase(key_of(unit));
    } else {
      if (auto merged = books_.job.film.merge(*film); !merged) {
        books_.seen.damage.push_back(merged.error().message);
      }
      ++books_.seen.accepted;
      core::Unit leased = unit;
      if (const auto found = books_.leased.find(key_of(unit)); found != books_.leased.end()) {
        leased = found->second.unit;
        books_.leased.erase(found);
      }
      if (unit.batches.count < leased.batches.count) {
        ++books_.seen.shortened;
        leased.batches = {unit.batches.end(), leased.batches.end() - unit.batches.end()};
        books_.job.units.push_back(leased);
      }
    }
    if (!books_.owner->acknowledge) return;
    v1::CoordinatorMessage message;
    v1::LeasedUnit& done = *message.mutable_acknowledge()->mutable_unit();
    *done.mutable_lease() = result.lease();
    done.set_job(result.job());
    *done.mutable_unit() = result.unit();
    stream->Write(message);
  }

  Books& books_;
};

FakeCoordinator::FakeCoordinator(Job job) : books_(std::make_unique<Books>()) {
  books_->owner = this;
  books_->job = std::move(job);
  books_->work = std::make_unique<WorkService>(*books_);
  books_->assets = std::make_unique<AssetService>(*books_);
  start();
}

FakeCoordinator::~FakeCoordinator() { stop(); }

void FakeCoordinator::start() {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:" + std::to_string(books_->port),
                           grpc::InsecureServerCredentials(), &books_->port);
  builder.RegisterService(books_->work.get());
  builder.RegisterService(books_->assets.get());
  books_->server = builder.BuildAndStart();
}

void FakeCoordinator::stop() {
  books_->server->Shutdown(std::chrono::system_clock::now());
  books_->server->Wait();
}

std::string FakeCoordinator::address() const { return "127.0.0.1:" + std::to_string(books_->port); }

void FakeCoordinator::expire_leases() {
  const std::lock_guard lock(books_->mutex);
  for (const auto& [key, leased] : books_->leased) books_->job.units.push_back(leased.unit);
  books_->leased.clear();
}

bool FakeCoordinator::wait_until(const std::function<bool(const Seen&)>& reached,
                                 std::chrono::seconds limit) {
  std::unique_lock lock(books_->mutex);
  return books_->changed.wait_for(lock, limit, [&] { return reached(books_->seen); });
}

bool FakeCoordinator::wait_for_all() {
  std::unique_lock lock(books_->mutex);
  return books_->changed.wait_for(lock, std::chrono::seconds(120), [&] {
    return books_->job.units.empty() && books_->leased.empty();
  });
}

FakeCoordinator::Seen FakeCoordinator::seen() const {
  const std::lock_guard lock(books_->mutex);
  return books_->seen;
}

std::string FakeCoordinator::film_digest() const {
  const std::lock_guard lock(books_->mutex);
  return books_->job.film.digest();
}

}  // namespace hyades::worker
