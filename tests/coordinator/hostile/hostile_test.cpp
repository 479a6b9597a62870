// Clients and workers that mean ill: the coordinator stays small, lives, and serves the others.
#include <atomic>
#include <thread>
#include <vector>

#include "tests/coordinator/hostile/hostile_world.h"

namespace hyades::coordinator {
namespace {

/// MiB. What may have come and not be dealt with (server.cpp), and as much again for what is.
constexpr uint64_t kReceived = 512;

TEST_F(Hostile, MessagesThatAreAnnouncedAndNeverEndAreBrokenOff) {
  const std::string piece(size_t{4} << 20U, '\0');
  std::vector<std::unique_ptr<test::RawHttp2>> peers;
  // Whoever is admitted may announce 4 GiB, and gRPC takes it all in before anybody can look at it.
  uint64_t sent = 0;
  for (const char* method : {"/hyades.v1.Jobs/Submit", "/hyades.v1.Work/Attend",
                             "/hyades.v1.Farm/Info", "/hyades.v1.Assets/Upload"}) {
    peers.push_back(std::make_unique<test::RawHttp2>(world.address));
    test::RawHttp2& peer = *peers.back();
    EXPECT_TRUE(peer.greeted(20'000));
    const uint32_t call = peer.call(method);
    peer.send(call, test::RawHttp2::head(0xFFFFFFFF));
    for (int i = 0; i < 75; ++i) {
      const uint64_t now = peer.send(call, piece);
      sent += now;
      if (now < piece.size()) break;
    }
  }
  EXPECT_GT(sent, uint64_t{400} << 20U) << "the quota was never reached";
  expect_served();
  peers.clear();
  expect_served();
  // What is on its way when the quota is full comes in all the same: some 100 MiB, without a quota
  // 600.
  expect_sane(kReceived + kUsual + 100);
}

/// Some gigabyte and a half of zeros as gzip (RFC 1951 and 1952): a zero, and 258 more of what came
/// last again and again, 13 bits each.
std::string packed_zeros(int times) {
  std::string bytes("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
  uint32_t bits = 0;
  int count = 0;
  const auto put = [&](uint32_t code, int length) {  // codes begin with their highest bit
    for (int i = length - 1; i >= 0; --i) {
      bits |= (code >> i & 1U) << count;
      if (++count < 8) continue;
      bytes += static_cast<char>(bits);
      bits = 0;
      count = 0;
    }
  };
  put(0b110, 3);  // the last block, with the fixed codes
  put(0b00110000, 8);
  for (int i = 0; i < times; ++i) put(0b1100010100000, 13);
  put(0, 7 + 8);                        // its end; whole bytes
  return bytes + std::string(8, '\0');  // a checksum that nobody gets to look at
}

TEST_F(Hostile, PackedMessagesAreNotUnpacked) {
  const std::string packed = packed_zeros(2'000'000);
  for (const char* method : {"/hyades.v1.Jobs/Submit", "/hyades.v1.Work/Attend"}) {
    test::RawHttp2 peer(world.address);
    const uint32_t call = peer.call(method, {{"grpc-encoding", "gzip"}});
    peer.send(call, test::RawHttp2::head(static_cast<uint32_t>(packed.size()), true) + packed);
    EXPECT_TRUE(peer.ended(call, 5000)) << method;
  }
  expect_served();
  expect_sane(kUsual);
}

TEST_F(Hostile, RequestsOfNothingButEmptyParts) {
  std::string files;
  for (int i = 0; i < 8'000'000; ++i) files += std::string("\x12\0", 2);
  // A spec with eight million files, of two bytes each.
  const std::string bytes = std::string("\x0a\x80\xc8\xd0\x07", 5) + files;
  ASSERT_EQ(files.size(), 16'000'000U);
  EXPECT_EQ(call("/hyades.v1.Jobs/Submit", bytes, 20s).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  expect_served();
  expect_sane(kUsual);
}

TEST_F(Hostile, AThousandIdleConnections) {
  std::vector<std::unique_ptr<test::RawHttp2>> peers;
  for (int i = 0; i < 1000; ++i) {
    peers.push_back(std::make_unique<test::RawHttp2>(world.address, i % 3 > 0));
    ASSERT_TRUE(peers.back()->connected()) << i;
    // A third has begun a call and half a message, and leaves it at that.
    if (i % 3 == 2) {
      test::RawHttp2& peer = *peers.back();
      peer.send(peer.call("/hyades.v1.Work/Attend"), test::RawHttp2::head(1000) + "half");
    }
  }
  expect_served();
  expect_sane(kUsual);
}

TEST_F(Hostile, UploadsWithoutEnd) {
  std::atomic<bool> over{false};
  std::vector<std::thread> threads;
  std::atomic<int> refused{0};
  for (int kind = 0; kind < 3; ++kind) {
    threads.emplace_back([&, kind] {
      for (int i = 0; i < 20 && !over; ++i) {
        const auto context = world.context();
        v1::UploadResponse response;
        const auto writer = world.assets->Upload(context.get(), &response);
        v1::UploadPart part;
        part.set_sha256(std::string(32, static_cast<char>(10 * kind + i)));
        part.set_size(kind == 0 ? 1000 : uint64_t{1} << 20U);
        part.mutable_chunk()->set_data(std::string(kind == 1 ? 0 : 1000, 'x'));
        // More than was announced; nothing at all again and again; the same bytes again and again.
        while (!over && writer->Write(part)) {
          if (kind == 0) part.mutable_chunk()->set_offset(part.chunk().offset() + 1000);
        }
        const grpc::Status status = writer->Finish();
        refused += status.error_code() == grpc::StatusCode::INVALID_ARGUMENT ||
                   status.error_code() == grpc::StatusCode::DATA_LOSS;
      }
    });
  }
  expect_served();
  EXPECT_TRUE(eventually([&] { return refused == 60; })) << refused;
  over = true;
  for (std::thread& thread : threads) thread.join();
  expect_sane(kUsual);
}

TEST_F(Hostile, ReadersThatDoNotRead) {
  const uint64_t job = world.submit(20'000);
  v1::JobRequest paused;
  paused.set_job(job);
  v1::JobResponse ignored;
  ASSERT_TRUE(world.jobs->Pause(world.context().get(), paused, &ignored).ok());
  v1::WatchRequest watch;  // every method's first field is the job
  watch.set_job(job);
  std::string request = watch.SerializeAsString();
  request.insert(0, test::RawHttp2::head(static_cast<uint32_t>(request.size())));
  std::vector<std::unique_ptr<test::RawHttp2>> peers;
  for (int i = 0; i < 60; ++i) {
    peers.push_back(std::make_unique<test::RawHttp2>(world.address));
    test::RawHttp2& peer = *peers.back();
    if (i % 2 == 0) peer.open_windows();
    for (const char* method : {"/hyades.v1.Jobs/Watch", "/hyades.v1.Jobs/Get",
                               "/hyades.v1.Jobs/Outputs", "/hyades.v1.Jobs/Logs"}) {
      for (int k = 0; k < 5; ++k) {
        const uint32_t call = peer.call(method);
        peer.send(call, request);
        peer.finish(call);
      }
    }
  }
  expect_served();
  expect_sane(kUsual + 150);
}

}  // namespace
}  // namespace hyades::coordinator
