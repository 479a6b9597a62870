#include "worker/asset_fetcher.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/impl/rpc_method.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include "core/base/hash.h"
#include "farm/backoff.h"
#include "farm/channel.h"
#include "farm/message_bytes.h"
#include "farm/part_count.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/assets.pb.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;

constexpr const char* kDownloadMethod = "/hyades.v1.Assets/Download";
/// Jobs whose files are fetched at the same time.
constexpr int kThreads = 4;
constexpr milliseconds kFirstPause{200};
constexpr milliseconds kLongestPause{5000};
/// For trouble of this machine, which the units need not wait for: another may have none.
constexpr milliseconds kLocalPatience{5000};
/// A download slower than this many bytes per millisecond is broken off and resumed.
constexpr uint64_t kSlowest = 16;
constexpr milliseconds kShortestDeadline{60'000};
constexpr milliseconds kLongestDeadline = std::chrono::hours(6);  // whatever the size is said to be
/// In a piece, of fields that it does not have now.
constexpr uint64_t kMostPieceParts = 100;
/// Pieces of a file that have no bytes.
constexpr int kMostEmptyPieces = 100;

/// Half of the files that this process may have open.
size_t most_pins() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return 500;
  return files.rlim_cur == RLIM_INFINITY ? SIZE_MAX : files.rlim_cur / 2;
}

std::string name_of(const v1::JobFile& file) { return farm::hex_from_wire(file.sha256()); }

/// Reads a piece. Looked at before it is parsed: fields that no piece has, which are kept, take
/// many times their bytes.
core::Status read_piece(const grpc::ByteBuffer& bytes, v1::Chunk& piece) {
  if (!farm::has_few_parts(bytes, *v1::Chunk::descriptor(), kMostPieceParts)) {
    return core::Error{"a piece of too many parts came, or none that is known"};
  }
  const grpc::Status read = farm::parse(bytes, farm::kMaxMessageBytes, piece);
  if (!read.ok()) return core::Error{read.error_message()};
  return {};
}

/// What is wrong with a piece that comes for the writer.
core::Status check_piece(const v1::Chunk& piece, const farm::ContentWriter& writer) {
  if (piece.offset() != writer.offset()) {
    return core::Error{
        fmt::format("a piece from byte {} came, {} was expected", piece.offset(), writer.offset())};
  }
  if (piece.data().size() > writer.size() - writer.offset()) {
    return core::Error{fmt::format("it has more than {} bytes", writer.size())};
  }
  return {};
}

/// Of a file whose name is one.
core::Sha256 digest_of(const v1::JobFile& file) {
  core::Sha256 digest{};
  std::copy(file.sha256().begin(), file.sha256().end(), digest.begin());
  return digest;
}

}  // namespace

class AssetFetcher::FileClaim {
 public:
  /// Waits for those who are before; they may have brought the file.
  FileClaim(AssetFetcher& fetcher, const Wanted& wanted, std::string name)
      : fetcher_(fetcher), name_(std::move(name)) {
    const core::MutexLock lock(fetcher_.mutex_);
    while (!fetcher_.unwanted(wanted) && fetcher_.claimed_.contains(name_)) {
      fetcher_.wake_.wait(fetcher_.mutex_);
    }
    mine_ = !fetcher_.unwanted(wanted) && fetcher_.claimed_.insert(name_).second;
  }
  ~FileClaim() {
    if (!mine_) return;
    const core::MutexLock lock(fetcher_.mutex_);
    fetcher_.claimed_.erase(name_);
    fetcher_.wake_.notify_all();
  }
  FileClaim(const FileClaim&) = delete;
  FileClaim& operator=(const FileClaim&) = delete;

  /// Else the file is not wanted any more.
  bool is_mine() const { return mine_; }

 private:
  AssetFetcher& fetcher_;
  const std::string name_;
  bool mine_ = false;
};

AssetFetcher::AssetFetcher(std::shared_ptr<farm::Channels> channels, std::string token,
                           farm::ContentStore& store, Listener& listener, milliseconds patience)
    : channels_(std::move(channels)),
      store_(store),
      listener_(listener),
      patience_(patience),
      most_pins_(most_pins()),
      token_(std::move(token)),
      cache_bytes_(store.used()) {
  for (int i = 0; i < kThreads; ++i) threads_.emplace_back([this] { loop(); });
}

void AssetFetcher::set_token(std::string token) {
  const core::MutexLock lock(mutex_);
  token_ = std::move(token);
}

AssetFetcher::~AssetFetcher() {
  {
    const core::MutexLock lock(mutex_);
    stop_ = true;
    for (const auto& wanted : in_work_) {
      if (wanted->call != nullptr) wanted->call->TryCancel();
    }
    wake_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
}

void AssetFetcher::fetch(uint64_t job, const v1::JobSpec& spec) {
  const core::MutexLock lock(mutex_);
  wanted_.push_back(std::make_shared<Wanted>(Wanted{job, spec.SerializeAsString()}));
  wake_.notify_all();  // of those who wait not all wait for this
}

void AssetFetcher::recheck(const std::string& file) {
  const core::MutexLock lock(mutex_);
  to_recheck_.insert(file);
}

void AssetFetcher::check_again(const std::string& name) {
  {
    const core::MutexLock lock(mutex_);
    if (to_recheck_.erase(name) == 0) return;
  }
  store_.check_again(name);
}

void AssetFetcher::release(uint64_t job) {
  std::vector<farm::ContentPin> released;  // let go of without the lock
  const core::MutexLock lock(mutex_);
  std::erase_if(wanted_, [&](const auto& wanted) { return wanted->job == job; });
  for (const auto& wanted : in_work_) {
    if (wanted->job != job) continue;
    wanted->dropped = true;
    if (wanted->call != nullptr) wanted->call->TryCancel();
    wake_.notify_all();
  }
  if (const auto files = pinned_.find(job); files != pinned_.end()) {
    released = let_go(files->second);
    pinned_.erase(files);
  }
}

bool AssetFetcher::has_files(uint64_t job) {
  const core::MutexLock lock(mutex_);
  return pinned_.contains(job);
}

/// Counts the files as in work; an error where they are more than may be open.
AssetFetcher::Outcome AssetFetcher::keep(const Digests& files) {
  if (files.size() > most_pins_) {
    return Failure{fmt::format("the job has {} files; this worker can keep {} at once (ulimit -n)",
                               files.size(), most_pins_),
                   FilesTrouble::hopeless};
  }
  const core::MutexLock lock(mutex_);
  size_t others = 0;
  for (const core::Sha256& file : files) others += kept_.contains(file) ? 0 : 1;
  if (kept_.size() + others > most_pins_) {
    return Failure{
        fmt::format("the job has {} files that are not in use; this worker can keep {} at once "
                    "(ulimit -n), and other jobs have {}",
                    others, most_pins_, kept_.size())};
  }
  for (const core::Sha256& file : files) ++kept_[file].jobs;
  return std::nullopt;
}

/// Undoes keep(); the pins that go are to be let go of without the lock.
std::vector<farm::ContentPin> AssetFetcher::let_go(const Digests& files) {
  std::vector<farm::ContentPin> pins;
  for (const core::Sha256& file : files) {
    const auto kept = kept_.find(file);
    if (--kept->second.jobs > 0) continue;
    if (kept->second.pin) pins.push_back(std::move(*kept->second.pin));
    kept_.erase(kept);
  }
  return pins;
}

void AssetFetcher::loop() {
  for (;;) {
    std::shared_ptr<Wanted> wanted;
    {
      const core::MutexLock lock(mutex_);
      while (!stop_ && wanted_.empty()) wake_.wait(mutex_);
      if (stop_) return;
      wanted = std::move(wanted_.front());
      wanted_.pop_front();
      in_work_.push_back(wanted);
    }
    const Outcome failed = fetch_all(*wanted);
    cache_bytes_ = store_.used();
    {
      const core::MutexLock lock(mutex_);
      if (stop_) return;
      std::erase(in_work_, wanted);
      if (wanted->dropped) continue;
    }
    if (failed) {
      listener_.files_failed(wanted->job, failed->reason, failed->trouble);
    } else {
      listener_.files_are_there(wanted->job);
    }
  }
}

AssetFetcher::Outcome AssetFetcher::fetch_all(Wanted& wanted) {
  v1::JobSpec spec;
  spec.ParseFromString(wanted.spec);
  Digests files;
  files.reserve(static_cast<size_t>(spec.files_size()));
  for (const v1::JobFile& file : spec.files()) {
    if (file.sha256().size() != sizeof(core::Sha256)) {
      return Failure{file.path() + ": its name is no SHA-256", FilesTrouble::hopeless};
    }
    files.push_back(digest_of(file));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  if (auto failed = keep(files)) return failed;
  Outcome failed = fetch_each(wanted, spec);
  std::vector<farm::ContentPin> released;  // let go of without the lock
  const core::MutexLock lock(mutex_);
  if (!failed && unwanted(wanted)) failed = Failure{"no longer wanted"};
  if (failed) {
    released = let_go(files);
    return failed;
  }
  std::swap(pinned_[wanted.job], files);
  released = let_go(files);  // that the job had before
  return std::nullopt;
}

AssetFetcher::Outcome AssetFetcher::fetch_each(Wanted& wanted, const v1::JobSpec& spec) {
  for (const v1::JobFile& file : spec.files()) {
    const std::string name = name_of(file);
    // Another process may evict a file before it is pinned.
    for (int attempt = 0;; ++attempt) {
      if (auto failed = fetch_file(wanted, file)) return failed;
      auto pin = store_.pin(name);
      if (pin) {
        // In place of another job's, which may be of a file that was damaged.
        const core::MutexLock lock(mutex_);
        kept_.at(digest_of(file)).pin = std::move(*pin);
        break;
      }
      if (attempt == 2) {
        return Failure{pin.error().in(file.path()).message, FilesTrouble::machine};
      }
    }
  }
  return std::nullopt;
}

/// Nothing to do where the file is there.
AssetFetcher::Outcome AssetFetcher::fetch_file(Wanted& wanted, const v1::JobFile& file) {
  const std::string name = name_of(file);
  check_again(name);
  if (store_.contains(name, file.size())) {
    ++hits_;
    return std::nullopt;
  }
  ++misses_;
  const FileClaim claim(*this, wanted, name);
  if (!claim.is_mine()) return Failure{"no longer wanted"};
  if (store_.contains(name, file.size())) return std::nullopt;
  return fetch_patiently(wanted, file);
}

AssetFetcher::Outcome AssetFetcher::fetch_patiently(Wanted& wanted, const v1::JobFile& file) {
  const auto begun = std::chrono::steady_clock::now();
  farm::Backoff backoff(kFirstPause, kLongestPause);
  for (;;) {
    Outcome failed = download(wanted, file);
    if (!failed || !failed->again) return failed;
    const milliseconds patience = failed->local ? std::min(kLocalPatience, patience_) : patience_;
    if (std::chrono::steady_clock::now() - begun >= patience) return failed;
    if (!pause(wanted, backoff.next(std::min(failed->retry_after, kLongestPause)))) return failed;
  }
}

/// Waits; false when the files are no longer wanted.
bool AssetFetcher::pause(const Wanted& wanted, farm::Backoff::Duration time) {
  const auto end = std::chrono::steady_clock::now() + time;
  const core::MutexLock lock(mutex_);
  while (!unwanted(wanted) && std::chrono::steady_clock::now() < end) wake_.wait_until(mutex_, end);
  return !unwanted(wanted);
}

/// Nobody else's.
AssetFetcher::Failure AssetFetcher::local_trouble(const core::Error& error, FilesTrouble trouble) {
  Failure failure;
  failure.reason = error.message;
  failure.trouble = trouble;
  failure.again = true;
  failure.local = true;
  return failure;
}

AssetFetcher::Outcome AssetFetcher::download(Wanted& wanted, const v1::JobFile& file) {
  bool crowded = false;
  auto writer = store_.write(name_of(file), file.size(), {}, &crowded);
  if (!writer) {
    return local_trouble(writer.error().in(file.path()),
                         crowded ? FilesTrouble::job : FilesTrouble::machine);
  }
  grpc::ClientContext context;
  {
    const core::MutexLock lock(mutex_);
    const uint64_t longest = kLongestDeadline.count();
    farm::prepare(
        context, token_,
        std::max(kShortestDeadline, milliseconds(std::min(file.size() / kSlowest, longest))));
    if (unwanted(wanted)) return Failure{"no longer wanted"};
    wanted.call = &context;
  }
  v1::DownloadRequest request;
  request.set_sha256(file.sha256());
  request.set_offset(writer->offset());
  // As a stub does it, but for the bytes.
  const grpc::internal::RpcMethod method(kDownloadMethod,
                                         grpc::internal::RpcMethod::SERVER_STREAMING);
  const std::unique_ptr<grpc::ClientReader<grpc::ByteBuffer>> stream(
      grpc::internal::ClientReaderFactory<grpc::ByteBuffer>::Create(
          channels_->current().channel.get(), method, &context, request));
  grpc::ByteBuffer bytes;
  v1::Chunk chunk;
  int empty = 0;
  core::Status fits;  // what the coordinator sends
  core::Status kept;
  while (kept && stream->Read(&bytes)) {
    fits = read_piece(bytes, chunk);
    if (fits) fits = check_piece(chunk, *writer);
    if (fits && chunk.data().empty() && ++empty > kMostEmptyPieces) {
      fits = core::Error{"pieces without bytes came"};
    }
    if (!fits) break;
    kept = writer->append(std::as_bytes(std::span(chunk.data())));
  }
  if (!fits || !kept) context.TryCancel();
  const grpc::Status status = stream->Finish();
  {
    const core::MutexLock lock(mutex_);
    wanted.call = nullptr;
  }
  if (!fits) return Failure{file.path() + " cannot be fetched: " + fits.error().message};
  if (!kept) return local_trouble(kept.error().in(file.path()), FilesTrouble::machine);
  if (!status.ok()) {
    // Even a file that is not there may be uploaded again; and giving units back at once would only
    // bring them here again at once.
    return Failure{file.path() + " cannot be fetched: " + status.error_message(), FilesTrouble::job,
                   true, false, milliseconds(farm::detail_of(status).retry_after_ms())};
  }
  // Fewer bytes than the job says that there are, or others.
  if (auto done = writer->commit(); !done) {
    return local_trouble(done.error().in(file.path()), FilesTrouble::job);
  }
  return std::nullopt;
}

}  // namespace hyades::worker
