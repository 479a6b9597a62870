// How long a coordinator is waited for.
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

TEST(PatienceTest, GrowsAndEnds) {
  const auto begin = Patience::Clock::time_point();
  const auto after = [&](double s) {
    return begin +
           std::chrono::duration_cast<Patience::Clock::duration>(std::chrono::duration<double>(s));
  };
  Patience patience(2, 1000);
  const double first = patience.next_wait(begin);
  EXPECT_GT(first, 0);
  EXPECT_LE(first, 0.1);
  EXPECT_LT(patience.next_wait(after(2.0)), 0);
  patience.reached();
  for (int i = 0; i < 20; ++i) EXPECT_GT(patience.next_wait(after(100)), 0);
  EXPECT_GE(patience.next_wait(after(101)), 2.5);
  EXPECT_LE(patience.next_wait(after(102)), 5.0);
  const double asked = patience.next_wait(after(103), 60);
  EXPECT_GE(asked, 62.5) << "not with all others that were asked";
  EXPECT_LE(asked, 65);
  EXPECT_LT(patience.next_wait(after(1200)), 0);
}

}  // namespace
}  // namespace hyades::cli
