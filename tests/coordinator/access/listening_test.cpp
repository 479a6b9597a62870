// At which addresses a coordinator listens.
#include "coordinator/access/listening.h"

#include <gtest/gtest.h>

#include <string>

namespace hyades::coordinator {
namespace {

TEST(Listening, IsAtAllThatANameStandsFor) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "localhost:0", "127.0.0.1:0"}) {
    const auto listening = listen_at({address});
    if (!listening && std::string(address) == "[::]:0") continue;  // no IPv6 here
    ASSERT_TRUE(listening.ok()) << listening.error().message;
    ASSERT_NE(listening->port, 0) << address;
    const std::string port = std::to_string(listening->port);
    EXPECT_FALSE(listen_at({"127.0.0.1:" + port}).ok()) << address;
    // Who calls localhost may come by either, whatever the list of hosts says.
    const bool both = std::string(address).starts_with("localhost");
    EXPECT_FALSE(both && listen_at({"[::1]:" + port}).ok());
  }
  const auto nowhere = listen_at({"192.0.2.7:0"});
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().message.find("192.0.2.7:0: cannot listen there"), std::string::npos);
  const auto both = listen_at({"127.0.0.1:0", "127.0.0.2:0"});
  ASSERT_TRUE(both.ok()) << both.error().message;
  EXPECT_EQ(both->sockets.size(), 2U);
  const auto half = listen_at({"127.0.0.1:0", "192.0.2.7:0"});
  ASSERT_FALSE(half.ok()) << "callers of the other would find nobody";
  EXPECT_NE(half.error().message.find("(192.0.2.7: "), std::string::npos) << half.error().message;
}

}  // namespace
}  // namespace hyades::coordinator
