#include "worker/worker_identity.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "tests/support/temp_folder.h"

namespace hyades::worker {
namespace {

TEST(WorkerIdentity, StaysTheSameOverRestarts) {
  const test::TempFolder folder;
  std::string first;
  {
    const auto id = WorkerIdentity::take(folder.path(), "host");
    ASSERT_TRUE(id.ok());
    first = id->text();
    EXPECT_EQ(first.size(), 32U);
  }
  EXPECT_EQ(WorkerIdentity::take(folder.path(), "host")->text(), first);
}

TEST(WorkerIdentity, WorkersThatShareACacheHaveTheirOwn) {
  const test::TempFolder folder;
  auto one = std::optional(WorkerIdentity::take(folder.path(), "host"));
  const auto two = WorkerIdentity::take(folder.path(), "host");
  ASSERT_TRUE(one->ok() && two.ok());
  const std::string first = (*one)->text();
  EXPECT_NE(first, two->text());
  one.reset();
  EXPECT_EQ(WorkerIdentity::take(folder.path(), "host")->text(), first) << "its successor";
}

TEST(WorkerIdentity, IsMadeAnewOnAnotherHostAndWhereItIsTorn) {
  const test::TempFolder folder;
  const std::string first = WorkerIdentity::take(folder.path(), "host")->text();
  const std::string other = WorkerIdentity::take(folder.path(), "other")->text();
  EXPECT_NE(first, other);
  std::ofstream(folder.file("worker-0.id")) << other.substr(0, 20);
  const std::string third = WorkerIdentity::take(folder.path(), "other")->text();
  EXPECT_EQ(third.size(), 32U);
  EXPECT_NE(third.substr(0, 20), other.substr(0, 20));
}

TEST(WorkerIdentity, TwoMachinesWithOneHostNameAreTold) {
  const test::TempFolder folder;
  std::ofstream(folder.file("one")) << "0123456789abcdef0123456789abcdef\n";
  std::ofstream(folder.file("two")) << "fedcba9876543210fedcba9876543210\n";
  const std::string one = machine_name("render", folder.file("one"));
  const std::string two = machine_name("render", folder.file("two"));
  EXPECT_NE(one, two);
  EXPECT_EQ(one, machine_name("render", folder.file("one")));
  EXPECT_EQ(one.find("0123456789abcdef"), std::string::npos) << "the id itself is not given away";
  EXPECT_EQ(machine_name("render", folder.file("none")), "render");
  const std::string first = WorkerIdentity::take(folder.path(), one)->text();
  EXPECT_NE(WorkerIdentity::take(folder.path(), two)->text(), first);
}

TEST(WorkerIdentity, ANewOneStays) {
  const test::TempFolder folder;
  std::string renewed;
  {
    auto id = WorkerIdentity::take(folder.path(), "host");
    const std::string first = id->text();
    ASSERT_TRUE(id->renew().ok());
    renewed = id->text();
    EXPECT_NE(renewed, first);
  }
  EXPECT_EQ(WorkerIdentity::take(folder.path(), "host")->text(), renewed);
}

TEST(WorkerIdentity, AFolderThatCannotBeWrittenIsAnError) {
  const auto id = WorkerIdentity::take("/proc/no-such-folder", "host");
  ASSERT_FALSE(id.ok());
  EXPECT_NE(id.error().message.find("worker-0.id"), std::string::npos);
}

}  // namespace
}  // namespace hyades::worker
