#include "cli/transfer_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>

namespace hyades::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr uint64_t kMiB = uint64_t{1} << 20U;

TEST(TransferLine, SaysBytesRateAndTimeLeft) {
  Transfer transfer;
  transfer.what = "uploading";
  transfer.file = "2 of 7";
  transfer.moved = 30 * kMiB;
  transfer.total = 120 * kMiB;
  transfer.bytes_per_second = 3.0 * kMiB;
  EXPECT_EQ(transfer_line(transfer, false),
            "uploading   25 %  file 2 of 7  30.0 MiB of 120.0 MiB  3.0 MiB/s  30 s left");
  EXPECT_THAT(transfer_line(transfer, true), HasSubstr("██████░░"));
}

TEST(TransferLine, SaysNothingThatIsNotKnown) {
  Transfer transfer;
  transfer.what = "fetching";
  EXPECT_EQ(transfer_line(transfer, true), "fetching  0 B");
  transfer.total = 10;
  transfer.moved = 30;
  EXPECT_EQ(transfer_line(transfer, false), "fetching  100 %  10 B of 10 B");
}

TEST(TransferDisplay, TheRateIsThatOfTheLastSeconds) {
  TransferDisplay::Clock::time_point now;
  TransferDisplay display("fetching", true, [&] { return now; });
  display.expect(1000 * kMiB);
  EXPECT_EQ(display.transfer().bytes_per_second, 0.0);
  const auto move = [&](int count, uint64_t bytes) {
    for (int i = 0; i < count; ++i) {
      now += seconds(1);
      display.moved(bytes);
    }
  };
  move(20, kMiB);
  EXPECT_NEAR(display.transfer().bytes_per_second, 1.0 * kMiB, 0.01 * kMiB);
  move(20, 8 * kMiB);
  EXPECT_NEAR(display.transfer().bytes_per_second, 8.0 * kMiB, 0.01 * kMiB);
  display.spare(500 * kMiB);
  EXPECT_EQ(display.transfer().total, 500 * kMiB);
}

/// Three megabytes in half a minute, each after ten seconds.
void show_transfer() {
  TransferDisplay::Clock::time_point now;
  TransferDisplay display("uploading", false, [&] { return now; });
  display.expect(3 * kMiB);
  for (int i = 0; i < 3; ++i) {
    now += seconds(10);
    display.moved(kMiB);
  }
}

TEST(TransferDisplay, PlainLinesNowAndThenWhereNothingCanBeDrawnAgain) {
  ::testing::internal::CaptureStderr();
  show_transfer();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "uploading   33 %  1.0 MiB of 3.0 MiB  102.4 KiB/s  20 s left\n"
            "uploading   67 %  2.0 MiB of 3.0 MiB  102.4 KiB/s  10 s left\n"
            "uploading  100 %  3.0 MiB of 3.0 MiB  102.4 KiB/s  0 s left\n");
}

/// What a terminal of `columns` is sent, whose kind is `term`.
std::string on_terminal(unsigned short columns, const char* term) {
  winsize size{};
  size.ws_row = 24;
  size.ws_col = columns;
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    ::setenv("TERM", term, 1);
    show_transfer();
    std::fflush(nullptr);
    ::_exit(0);
  }
  std::string text;
  char piece[4096];
  for (ssize_t got = 0; (got = ::read(terminal, piece, sizeof piece)) > 0;) {
    text.append(piece, static_cast<size_t>(got));
  }
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status == 0 ? text : "the child died";
}

TEST(TransferDisplay, OneLineThatIsDrawnAgainOnATerminal) {
  const std::string text = on_terminal(120, "xterm");
  EXPECT_THAT(text, HasSubstr("\r\033[Kuploading  ████████░"));
  EXPECT_THAT(text, Not(HasSubstr("\n")));
  EXPECT_TRUE(text.ends_with("\r\033[K")) << "the line goes in the end";
}

TEST(TransferDisplay, TheLineIsCutToTheTerminal) {
  const std::string text = on_terminal(12, "xterm");
  const std::string drawn = "\r\033[Kuploading  ";
  EXPECT_EQ(text, drawn + drawn + drawn + "\r\033[K");
}

TEST(TransferDisplay, PlainLinesOnATerminalThatCannotDrawAgain) {
  const std::string text = on_terminal(120, "dumb");
  EXPECT_THAT(text, HasSubstr("uploading  100 %"));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
}

}  // namespace
}  // namespace hyades::cli
