#include "farm/wire.h"

#include <gtest/gtest.h>

#include <utility>

#include "farm/channel.h"
#include "farm/wire_status.h"

namespace hyades::farm {
namespace {

TEST(Wire, TextsAreCutAndCanBeRead) {
  EXPECT_EQ(wire_text("plain \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80"),
            "plain \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80");
  EXPECT_EQ(wire_text("\xFF|\xC3|\xC0\x80|\xED\xA0\x80|\xF4\x90\x80\x80|\xE2\x82"),
            "?|?|\?\?|\?\?\?|\?\?\?\?|\?\?");
  std::string long_text(kMaxTextBytes - 1, 'x');
  EXPECT_EQ(wire_text(long_text + "\xC3\xA4"), long_text) << "no half characters";
  v1::LogLine line;
  line.set_text(wire_text(std::string(1, '\xFE') + long_text + "\xC3\xA4"));
  EXPECT_TRUE(v1::LogLine().ParseFromString(line.SerializeAsString()));
}

TEST(Wire, UnitsAndFilmInfoComeBackAsTheyWent) {
  const core::Unit unit{-3, {32, 64, 64, 80}, {7, 9}};
  const auto back = from_wire(to_wire(unit));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(*back, unit);

  core::FilmInfo info;
  info.job_name = "balls";
  info.render_key = "abc";
  info.frame = 12;
  info.width = 640;
  info.height = 480;
  info.crop = {1, 2, 30, 40};
  info.samples = 17;
  info.worker_class = "c";
  info.build = "b";
  info.aim = {0.02F, -1.5F, 48};
  const auto same = from_wire(to_wire(info));
  ASSERT_TRUE(same.ok());
  EXPECT_EQ(same->job_name, info.job_name);
  EXPECT_EQ(same->render_key, info.render_key);
  EXPECT_EQ(same->frame, info.frame);
  EXPECT_EQ(same->width, info.width);
  EXPECT_EQ(same->height, info.height);
  EXPECT_EQ(same->crop, info.crop);
  EXPECT_EQ(same->samples, info.samples);
  EXPECT_EQ(same->worker_class, info.worker_class);
  EXPECT_EQ(same->build, info.build);
  EXPECT_EQ(same->aim, info.aim);
}

TEST(Wire, RefusesWhatIsNoUnit) {
  v1::Unit unit = to_wire(core::Unit{1, {0, 0, 32, 32}, {0, 1}});
  EXPECT_TRUE(from_wire(unit).ok());
  unit.set_batches(0);
  EXPECT_FALSE(from_wire(unit).ok());
  unit.set_batches(2);
  unit.set_first_batch(0xFFFFFFFFU);
  EXPECT_FALSE(from_wire(unit).ok());
  unit.set_first_batch(0);
  unit.mutable_tile()->set_x1(0);
  EXPECT_FALSE(from_wire(unit).ok());
  unit.mutable_tile()->set_x0(-2147483647);
  unit.mutable_tile()->set_x1(2147483647);
  EXPECT_FALSE(from_wire(unit).ok());
}

TEST(Wire, DigestsHaveThirtyTwoBytes) {
  const core::Sha256 digest = core::sha256("hyades");
  EXPECT_EQ(*digest_from_wire(to_wire(digest)), digest);
  EXPECT_EQ(*digest_from_hex(core::to_hex(digest)), digest);
  EXPECT_FALSE(digest_from_wire("short").ok());
  EXPECT_FALSE(digest_from_hex(std::string(63, '0')).ok());
  EXPECT_FALSE(digest_from_hex(std::string(64, 'x')).ok());
}

TEST(Wire, ErrorsCarryTheirDetails) {
  v1::ErrorDetail detail;
  detail.add_missing("abc");
  detail.set_retry_after_ms(5);
  const grpc::Status status = wire_status(grpc::StatusCode::FAILED_PRECONDITION, "no", detail);
  EXPECT_EQ(detail_of(status).missing(0), "abc");
  EXPECT_EQ(detail_of(status).retry_after_ms(), 5U);
  EXPECT_FALSE(is_retryable(status));
  EXPECT_EQ(detail_of(grpc::Status::OK).missing_size(), 0);
  EXPECT_TRUE(is_retryable(
      retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, "later", std::chrono::milliseconds(10))));
  const grpc::Status quota = over_quota("as many as you may have");
  EXPECT_EQ(quota.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(detail_of(quota).quota());
  EXPECT_FALSE(is_retryable(quota)) << "who has too much is told at once";
}

TEST(Channel, PlaintextStaysOnThisMachine) {
  EXPECT_TRUE(is_loopback("127.0.0.1:7700"));
  EXPECT_TRUE(is_loopback("localhost:1"));
  EXPECT_TRUE(is_loopback("[::1]:1"));
  EXPECT_FALSE(is_loopback("0.0.0.0:7700"));
  EXPECT_FALSE(is_loopback("127.example.org:7700"));
  Peer peer;
  EXPECT_TRUE(connect(peer).ok());
  peer.address = "farm.example:7700";
  EXPECT_FALSE(connect(peer).ok());
  peer.insecure = true;
  EXPECT_TRUE(connect(peer).ok());
  Listen listen;
  EXPECT_TRUE(open_door(listen).ok());
  listen.address = "0.0.0.0:7700";
  EXPECT_FALSE(open_door(listen).ok());
  listen.insecure = true;
  EXPECT_TRUE(open_door(listen).ok());
}

TEST(Channel, TroubleIsToldInOurWords) {
  const std::string plain_to_tls =
      "failed to connect to all addresses; last error: UNAVAILABLE: ipv4:10.0.0.1:7700: Socket "
      "closed";
  Peer peer;
  EXPECT_NE(connection_trouble(plain_to_tls, peer).find("--tls-ca"), std::string::npos);
  EXPECT_FALSE(tls_trouble("Socket closed", peer)) << "it was there, and has gone";
  peer.ca_file = "ca.pem";
  EXPECT_FALSE(tls_trouble(plain_to_tls, peer));
  for (const auto& [message, words] : {
           std::pair("Ssl handshake failed: SSL_ERROR_SSL: error:0A00010B:SSL routines::wrong "
                     "version number",
                     "does not speak TLS"),
           std::pair("SSL routines::certificate verify failed", "not signed by one in ca.pem"),
           std::pair("Hostname Verification Check failed.", "for another name"),
       }) {
    const auto told = tls_trouble(message, peer);
    ASSERT_TRUE(told) << message;
    EXPECT_NE(told->find(words), std::string::npos) << *told;
  }
  const std::string nobody =
      "failed to connect to all addresses; last error: UNKNOWN: ipv4:127.0.0.1:1: Failed to "
      "connect to remote host: Connection refused";
  EXPECT_EQ(connection_trouble(nobody, peer), "Connection refused");
}

}  // namespace
}  // namespace hyades::farm
