#include "worker/asset_fetcher.h"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include "core/base/hash.h"
#include "farm/channels.h"
#include "farm/wire.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "tests/support/temp_folder.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;

const std::string kSmall = "a small file";

std::string digest_of(const std::string& bytes) { return farm::to_wire(core::sha256(bytes)); }

/// Serves kSmall; of anything else a first byte, and then nothing until the caller goes.
class StuckAssets : public v1::Assets::Service {
 public:
  grpc::Status Download(grpc::ServerContext* context, const v1::DownloadRequest* request,
                        grpc::ServerWriter<v1::Chunk>* writer) override {
    v1::Chunk chunk;
    if (request->sha256() == digest_of(kSmall)) {
      chunk.set_offset(request->offset());
      chunk.set_data(kSmall.substr(request->offset()));
      writer->Write(chunk);
      return grpc::Status::OK;
    }
    chunk.set_data("x");
    writer->Write(chunk);
    std::unique_lock lock(mutex_);
    ++stuck_;
    changed_.notify_all();
    while (!context->IsCancelled()) changed_.wait_for(lock, std::chrono::milliseconds(5));
    ++gone_;
    changed_.notify_all();
    return grpc::Status::CANCELLED;
  }

  bool wait_until_stuck(int calls) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, seconds(20), [&] { return stuck_ >= calls; });
  }
  /// Waits until so many callers have given up.
  bool wait_until_gone(int calls) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, seconds(20), [&] { return gone_ >= calls; });
  }
  int stuck() {
    const std::lock_guard lock(mutex_);
    return stuck_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int stuck_ = 0;  ///< calls
  int gone_ = 0;   ///< of these
};

class Reports : public AssetFetcher::Listener {
 public:
  void files_are_there(uint64_t job) override { add(job, "there"); }
  void files_failed(uint64_t job, const std::string& reason, FilesTrouble trouble) override {
    add(job, (trouble == FilesTrouble::hopeless  ? "hopeless: "
              : trouble == FilesTrouble::machine ? "machine: "
                                                 : "job: ") +
                 reason);
  }

  /// Waits for the first report.
  std::vector<std::pair<uint64_t, std::string>> first() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(20), [this] { return !reports_.empty(); });
    return reports_;
  }
  /// Waits for the next report that was not taken yet.
  std::string next() {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, seconds(20), [this] { return !reports_.empty(); })) return {};
    const std::string what = reports_.front().second;
    reports_.erase(reports_.begin());
    return what;
  }

 private:
  void add(uint64_t job, const std::string& what) {
    const std::lock_guard lock(mutex_);
    reports_.emplace_back(job, what);
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<uint64_t, std::string>> reports_;
};

v1::JobSpec spec_of(const std::string& bytes) {
  v1::JobSpec spec;
  v1::JobFile& file = *spec.add_files();
  file.set_path("file");
  file.set_size(bytes.size());
  file.set_sha256(digest_of(bytes));
  return spec;
}

std::shared_ptr<farm::Channels> channels_to(int port) {
  farm::Peer peer;
  peer.address = "127.0.0.1:" + std::to_string(port);
  return *farm::Channels::open(peer);
}

struct Served {
  Served() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&assets);
    server = builder.BuildAndStart();
  }
  ~Served() { server->Shutdown(std::chrono::system_clock::now() + seconds(5)); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::shared_ptr<farm::Channels> channels() const { return channels_to(port); }

  StuckAssets assets;
  int port = 0;
  std::unique_ptr<grpc::Server> server;
};

TEST(AssetFetcher, AReleasedJobIsBrokenOffAndNotReported) {
  Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  fetcher.fetch(1, spec_of("something large"));
  fetcher.fetch(2, spec_of("something else that never comes"));
  ASSERT_TRUE(served.assets.wait_until_stuck(2));
  fetcher.release(2);
  fetcher.release(1);
  EXPECT_TRUE(served.assets.wait_until_gone(2));
  fetcher.fetch(3, spec_of(kSmall));
  const std::vector<std::pair<uint64_t, std::string>> expected{{3, "there"}};
  EXPECT_EQ(reports.first(), expected);
  EXPECT_FALSE(fetcher.has_files(1));
  EXPECT_TRUE(fetcher.has_files(3));
  fetcher.release(3);
  EXPECT_FALSE(fetcher.has_files(3)) << "whoever hears the report only now";
}

/// Its size and its times are those of the good file: only its bytes tell.
TEST(AssetFetcher, AFileThatIsDoubtedIsFetchedAgainWhereItIsDamaged) {
  Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  const std::string small = kSmall;
  const std::string name = farm::hex_from_wire(digest_of(small));
  const std::string path = folder.file("cache/" + name);
  {
    Reports reports;
    AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
    fetcher.fetch(1, spec_of(small));
    ASSERT_EQ(reports.first().at(0).second, "there");
  }
  const auto written = std::filesystem::last_write_time(path);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  std::fstream(path, std::ios::in | std::ios::out) << std::string(small.size(), '?');
  std::filesystem::last_write_time(path, written);
  ASSERT_TRUE((*store)->contains(name, small.size())) << "nobody has noticed";
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  fetcher.recheck(name);
  fetcher.fetch(2, spec_of(small));
  ASSERT_EQ(reports.first().at(0).second, "there");
  EXPECT_EQ(fetcher.misses(), 1U);
  std::ifstream file(path);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(bytes, small);
}

TEST(AssetFetcher, AFileThatDoesNotComeHoldsUpNobodyElse) {
  Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  fetcher.fetch(1, spec_of("something large"));
  fetcher.fetch(2, spec_of("something else that never comes"));
  ASSERT_TRUE(served.assets.wait_until_stuck(2));
  fetcher.fetch(3, spec_of("something large"));  // waits for job 1's
  fetcher.fetch(4, spec_of(kSmall));
  const std::vector<std::pair<uint64_t, std::string>> expected{{4, "there"}};
  EXPECT_EQ(reports.first(), expected);
  EXPECT_EQ(served.assets.stuck(), 2) << "no file is fetched twice at once";
  fetcher.release(1);
  EXPECT_TRUE(served.assets.wait_until_stuck(3)) << "now it is job 3's turn";
}

TEST(AssetFetcher, AFileThatTheCacheHasNoRoomForIsItsJobsTrouble) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), kSmall.size() - 1});
  ASSERT_TRUE(store.ok());
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, std::chrono::milliseconds(100));
  fetcher.fetch(1, spec_of(kSmall));
  const auto said = reports.first();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].second.starts_with("job: file: a file of ")) << said[0].second;
}

TEST(AssetFetcher, AFileOfAnotherLengthThanTheJobSaysIsItsJobsTrouble) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, std::chrono::milliseconds(100));
  v1::JobSpec spec = spec_of(kSmall);
  spec.mutable_files(0)->set_size(kSmall.size() - 1);
  fetcher.fetch(1, spec);
  EXPECT_EQ(reports.next(), "job: file cannot be fetched: it has more than 11 bytes");
  spec.mutable_files(0)->set_size(kSmall.size() + 1);
  fetcher.fetch(2, spec);
  const std::string fewer = reports.next();
  EXPECT_TRUE(fewer.starts_with("job: file: ")) << fewer;
  EXPECT_NE(fewer.find("12 of 13 bytes are there"), std::string::npos) << fewer;
}

TEST(AssetFetcher, ACacheThatCannotBeWrittenIsTheMachinesTrouble) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 1000});
  ASSERT_TRUE(store.ok());
  std::filesystem::remove_all(folder.file("cache"));
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, std::chrono::milliseconds(100));
  fetcher.fetch(1, spec_of(kSmall));
  const std::string said = reports.next();
  EXPECT_TRUE(said.starts_with("machine: file: ")) << said;
}

TEST(AssetFetcher, ACacheThatIsMendedSoonIsTriedAgain) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 1000});
  ASSERT_TRUE(store.ok());
  std::filesystem::rename(folder.file("cache"), folder.file("elsewhere"));
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  fetcher.fetch(1, spec_of(kSmall));
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  std::filesystem::rename(folder.file("elsewhere"), folder.file("cache"));
  const std::vector<std::pair<uint64_t, std::string>> expected{{1, "there"}};
  EXPECT_EQ(reports.first(), expected);
}

/// Sends the same piece again and again.
class EndlessAssets : public v1::Assets::Service {
 public:
  explicit EndlessAssets(v1::Chunk piece) : piece_(std::move(piece)) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }
  ~EndlessAssets() override { server_->Shutdown(std::chrono::system_clock::now()); }
  EndlessAssets(const EndlessAssets&) = delete;
  EndlessAssets& operator=(const EndlessAssets&) = delete;

  grpc::Status Download(grpc::ServerContext* /*context*/, const v1::DownloadRequest* /*request*/,
                        grpc::ServerWriter<v1::Chunk>* writer) override {
    while (writer->Write(piece_)) {
    }
    return grpc::Status::OK;
  }

  /// What a worker says that fetches a file of `size` bytes.
  std::string answer(uint64_t size) const {
    const test::TempFolder folder;
    const auto store = farm::ContentStore::open({folder.file("cache"), 0});
    EXPECT_TRUE(store.ok());
    Reports reports;
    AssetFetcher fetcher(channels_to(port_), "", **store, reports, seconds(60));
    v1::JobSpec spec = spec_of(kSmall);
    spec.mutable_files(0)->set_size(size);
    fetcher.fetch(1, spec);
    return reports.next();
  }

 private:
  const v1::Chunk piece_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

TEST(AssetFetcher, PiecesWithoutBytesAreNoFile) {
  const EndlessAssets assets{v1::Chunk()};
  EXPECT_EQ(assets.answer(uint64_t{1} << 62U),
            "job: file cannot be fetched: pieces without bytes came");
}

/// Each would take many times its bytes once it is parsed.
TEST(AssetFetcher, FieldsThatNoPieceHasAreNotParsed) {
  v1::Chunk piece;
  piece.set_data(kSmall);
  auto& fields = *piece.GetReflection()->MutableUnknownFields(&piece);
  for (int i = 0; i < 100; ++i) fields.AddVarint(1000, 1);
  // As many are known to a later coordinator, perhaps; then it is the second piece that fits not.
  EXPECT_EQ(EndlessAssets(piece).answer(kSmall.size()),
            "job: file cannot be fetched: a piece from byte 0 came, 12 was expected");
  fields.AddVarint(1000, 1);
  EXPECT_EQ(EndlessAssets(piece).answer(kSmall.size()),
            "job: file cannot be fetched: a piece of too many parts came, or none that is known");
}

/// Lowers the number of files that this process may have open while it lives.
class FewOpenFiles {
 public:
  explicit FewOpenFiles(rlim_t most) {
    EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &usual_), 0);
    const rlimit few{std::min(usual_.rlim_cur, most), usual_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  }
  ~FewOpenFiles() { ::setrlimit(RLIMIT_NOFILE, &usual_); }
  FewOpenFiles(const FewOpenFiles&) = delete;
  FewOpenFiles& operator=(const FewOpenFiles&) = delete;

 private:
  rlimit usual_{};
};

/// A job of `count` files that are in the store: numbers from `first` on.
v1::JobSpec numbered(farm::ContentStore& store, int first, int count) {
  v1::JobSpec spec;
  for (int i = first; i < first + count; ++i) {
    const std::string bytes = std::to_string(i);
    *spec.add_files() = spec_of(bytes).files(0);
    auto writer = store.write(farm::hex_from_wire(digest_of(bytes)), bytes.size());
    EXPECT_TRUE(writer && writer->append(std::as_bytes(std::span(bytes))) && writer->commit());
  }
  return spec;
}

/// Each is an open file, of which there are so many: no worker of this kind can have the job.
TEST(AssetFetcher, AJobOfMoreFilesThanMayBeOpenIsHopeless) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  const FewOpenFiles few(400);
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  v1::JobSpec large;
  for (int i = 0; i < 201; ++i) *large.add_files() = spec_of(std::to_string(i)).files(0);
  fetcher.fetch(1, large);
  EXPECT_EQ(reports.next(),
            "hopeless: the job has 201 files; this worker can keep 200 at once (ulimit -n)");
  fetcher.fetch(2, spec_of(kSmall));
  EXPECT_EQ(reports.next(), "there");
}

TEST(AssetFetcher, FilesThatJobsShareAreOpenOnce) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  const v1::JobSpec some = numbered(**store, 0, 150);
  const v1::JobSpec others = numbered(**store, 150, 100);
  v1::JobSpec twice = some;
  for (const v1::JobFile& file : some.files()) *twice.add_files() = file;
  const FewOpenFiles few(400);
  Reports reports;
  AssetFetcher fetcher(served.channels(), "", **store, reports, seconds(60));
  const auto get = [&](uint64_t job, const v1::JobSpec& spec) {
    fetcher.fetch(job, spec);
    return reports.next();
  };
  EXPECT_EQ(get(1, some), "there");
  EXPECT_EQ(get(1, some), "there") << "what a job has counts once, too";
  EXPECT_EQ(get(2, twice), "there") << "and what it names twice";
  EXPECT_EQ(get(3, others),
            "job: the job has 100 files that are not in use; this worker can keep 200 at once "
            "(ulimit -n), and other jobs have 150");
  fetcher.release(1);
  EXPECT_TRUE(get(3, others).starts_with("job: ")) << "job 2 has them still";
  EXPECT_FALSE((*store)->remove_unused(farm::hex_from_wire(some.files(7).sha256()), {}));
  fetcher.release(2);
  EXPECT_EQ(get(3, others), "there");
  EXPECT_TRUE((*store)->remove_unused(farm::hex_from_wire(some.files(7).sha256()), {}));
}

}  // namespace
}  // namespace hyades::worker
