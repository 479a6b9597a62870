#include "worker/asset_fetcher.h"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include "core/base/hash.h"
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
      chunk.set_data(kSmall);
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

class Reports : public AssetFetcher::Owner {
 public:
  void files_are_there(uint64_t job) override { add(job, "there"); }
  void files_failed(uint64_t job, const std::string& reason, bool final) override {
    add(job, (final ? "final: " : "") + reason);
  }

  /// Waits for the first report.
  std::vector<std::pair<uint64_t, std::string>> first() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(20), [this] { return !reports_.empty(); });
    return reports_;
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

  std::shared_ptr<grpc::Channel> channel() const {
    return grpc::CreateChannel("127.0.0.1:" + std::to_string(port),
                               grpc::InsecureChannelCredentials());
  }

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
  AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
  fetcher.fetch(1, spec_of("something large"));
  fetcher.fetch(2, spec_of("something else that never comes"));
  ASSERT_TRUE(served.assets.wait_until_stuck(2));
  fetcher.release(2);
  fetcher.release(1);
  EXPECT_TRUE(served.assets.wait_until_gone(2));
  fetcher.fetch(3, spec_of(kSmall));
  const std::vector<std::pair<uint64_t, std::string>> expected{{3, "there"}};
  EXPECT_EQ(reports.first(), expected);
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
    AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
    fetcher.fetch(1, spec_of(small));
    ASSERT_EQ(reports.first().at(0).second, "there");
  }
  const auto written = std::filesystem::last_write_time(path);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  std::fstream(path, std::ios::in | std::ios::out) << std::string(small.size(), '?');
  std::filesystem::last_write_time(path, written);
  ASSERT_TRUE((*store)->contains(name, small.size())) << "nobody has noticed";
  Reports reports;
  AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
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
  AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
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

TEST(AssetFetcher, TroubleOfTheCacheIsNeverFinal) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), kSmall.size() - 1});
  ASSERT_TRUE(store.ok());
  Reports reports;
  AssetFetcher fetcher(served.channel(), "", **store, reports, std::chrono::milliseconds(100));
  fetcher.fetch(1, spec_of(kSmall));
  const auto said = reports.first();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].second.starts_with("file: a file of ")) << said[0].second;
}

TEST(AssetFetcher, ACacheThatIsMendedSoonIsTriedAgain) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 1000});
  ASSERT_TRUE(store.ok());
  std::filesystem::rename(folder.file("cache"), folder.file("elsewhere"));
  Reports reports;
  AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
  fetcher.fetch(1, spec_of(kSmall));
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  std::filesystem::rename(folder.file("elsewhere"), folder.file("cache"));
  const std::vector<std::pair<uint64_t, std::string>> expected{{1, "there"}};
  EXPECT_EQ(reports.first(), expected);
}

/// Each is an open file, of which there are so many.
TEST(AssetFetcher, AJobOfMoreFilesThanMayBeOpenGoesBackAndOthersGoOn) {
  const Served served;
  const test::TempFolder folder;
  const auto store = farm::ContentStore::open({folder.file("cache"), 0});
  ASSERT_TRUE(store.ok());
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
  const rlimit few{std::min<rlim_t>(usual.rlim_cur, 400), usual.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  {
    Reports reports;
    AssetFetcher fetcher(served.channel(), "", **store, reports, seconds(60));
    v1::JobSpec large;
    for (int i = 0; i < 500; ++i) *large.add_files() = spec_of(kSmall).files(0);
    fetcher.fetch(1, large);
    const auto said = reports.first();
    ASSERT_EQ(said.size(), 1U);
    EXPECT_TRUE(said[0].second.starts_with("the job has 500 files; this worker can keep 200"))
        << said[0].second;
    Reports others;
    AssetFetcher fetcher_of_others(served.channel(), "", **store, others, seconds(60));
    for (const uint64_t job : {2, 2, 2}) {  // of which nothing is counted twice
      large.mutable_files()->DeleteSubrange(150, large.files_size() - 150);
      fetcher_of_others.fetch(job, large);
      EXPECT_EQ(others.first().back().second, "there");
      fetcher_of_others.release(job);
    }
  }
  ::setrlimit(RLIMIT_NOFILE, &usual);
}

}  // namespace
}  // namespace hyades::worker
