// The process that renders, played by scripts that say what a broken one might.

#include "worker/renderer_process.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class Ears : public RendererProcess::Listener {
 public:
  void renderer_says(pipe::FromRenderer message) override {
    const std::lock_guard lock(mutex_);
    said_.push_back(std::move(message));
    changed_.notify_all();
  }
  void renderer_ended(const std::string& reason) override {
    const std::lock_guard lock(mutex_);
    end_ = reason;
    changed_.notify_all();
  }
  size_t said() const {
    const std::lock_guard lock(mutex_);
    return said_.size();
  }
  bool wait_for(size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, seconds(60), [&] { return said_.size() >= count; });
  }
  std::string wait_for_end() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(60), [this] { return !end_.empty(); });
    return end_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<pipe::FromRenderer> said_;
  std::string end_;
};

/// A program of `lines`, for sh; what is in the file `words` of its folder it may say (>&3).
class Script {
 public:
  Script(const std::string& lines, const std::string& words) {
    std::ofstream(folder_.file("words"), std::ios::binary) << words;
    std::ofstream(folder_.file("program"))
        << "#!/bin/sh\ncd '" << folder_.path().string() << "'\n" + lines + "\n";
    ::chmod(folder_.file("program").c_str(), 0700);
  }
  std::unique_ptr<RendererProcess> start(RendererProcess::Listener& listener) {
    RendererOptions options;
    options.program = folder_.file("program");
    options.cache = folder_.path();
    auto started = RendererProcess::start(options, listener);
    EXPECT_TRUE(started) << started.error().message;
    return started ? std::move(*started) : nullptr;
  }
  std::string text(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_.file(name)).rdbuf();
    return text.str();
  }

 private:
  test::TempFolder folder_;
};

std::string ready_frame() {
  pipe::FromRenderer message;
  message.mutable_ready()->set_worker_class("class");
  return pipe::frame_message(message);
}

std::string started(uint64_t token) {
  pipe::FromRenderer message;
  message.mutable_started()->set_token(token);
  return pipe::frame_message(message);
}

TEST(RendererProcess, InheritsNoSecretsAndNoInput) {
  ::setenv("AWS_SECRET_ACCESS_KEY", "secret-of-a-cloud", 1);
  ::setenv("HYADES_TOKEN_FILE", "/secret-of-a-farm", 1);
  ::setenv("LC_TIME", "C.UTF-8", 1);
  ::setenv("HYADES_FAILPOINT", "of-a-test", 1);
  Script script(
      "tr '\\0' '\\n' </proc/$$/environ >environment; "
      "open=$(readlink /proc/$$/fd/0 /proc/$$/fd/1); echo \"$open\" >open",
      "");
  Ears ears;
  const auto process = script.start(ears);
  EXPECT_EQ(ears.wait_for_end(), "ended with status 0");
  for (const char* name :
       {"AWS_SECRET_ACCESS_KEY", "HYADES_TOKEN_FILE", "LC_TIME", "HYADES_FAILPOINT"}) {
    ::unsetenv(name);
  }
  const std::string environment = script.text("environment");
  EXPECT_EQ(environment.find("secret"), std::string::npos) << environment;
  EXPECT_NE(environment.find("PATH="), std::string::npos) << environment;
  EXPECT_NE(environment.find("LC_TIME=C.UTF-8"), std::string::npos) << environment;
  EXPECT_NE(environment.find("HYADES_FAILPOINT=of-a-test"), std::string::npos) << environment;
  EXPECT_EQ(script.text("open"), "/dev/null\n/dev/null\n");
}

TEST(RendererProcess, OneThatSaysLateThatItIsNotReadyIsKilled) {
  pipe::FromRenderer late;
  late.mutable_not_ready()->set_reason("this machine cannot render");
  Script script("cat words >&3; exec sleep 60",
                ready_frame() + started(1) + pipe::frame_message(late));
  Ears ears;
  const auto process = script.start(ears);
  EXPECT_EQ(ears.wait_for_end(), "said twice whether it is ready and was killed");
  EXPECT_EQ(ears.said(), 2U) << "and nobody is told that it is not ready";
}

TEST(RendererProcess, OneThatAnnouncesMoreThanAnyFilmIsKilled) {
  Script script("cat words >&3; exec sleep 60",
                ready_frame() + std::string("\0\0\0\0\xFF\xFF\xFF\x7F", 8));
  Ears ears;
  const auto process = script.start(ears);
  EXPECT_EQ(ears.wait_for_end(), "sent more than any message has and was killed");
}

TEST(RendererProcess, OneThatEndsWithinAMessageHasEndedAsItDid) {
  Script script("cat words >&3; kill -SEGV $$", ready_frame() + "\1");
  Ears ears;
  const auto process = script.start(ears);
  EXPECT_NE(ears.wait_for_end().find("crashed with signal 11"), std::string::npos);
}

TEST(RendererProcess, OneThatTalksWithoutEndIsReadOnlyAsItIsHeard) {
  constexpr size_t kMost = RendererProcess::kMostUnheard;
  std::string words = ready_frame();
  for (size_t i = 0; i < 3 * kMost; ++i) words += started(i);
  Script script("cat words >&3; exec sleep 60", words);
  Ears ears;
  const auto process = script.start(ears);
  ASSERT_TRUE(ears.wait_for(kMost));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(ears.said(), kMost);
  for (int i = 0; i < 10; ++i) process->heard();
  ASSERT_TRUE(ears.wait_for(kMost + 10));
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(ears.said(), kMost + 10);
  // And it can be ended while its reader waits.
}

TEST(RendererProcess, OneThatDoesNotReadIsKilledBeforeTooMuchWaitsForIt) {
  Script script("exec sleep 60", "");
  Ears ears;
  const auto process = script.start(ears);
  pipe::ToRenderer large;
  large.mutable_job()->mutable_spec()->set_document(std::string(size_t{16} << 20U, 'd'));
  for (size_t sent = 0; sent <= RendererProcess::kMostUnread; sent += size_t{16} << 20U) {
    process->send(large);
  }
  process->send(large);  // beyond what the pipe took
  EXPECT_EQ(ears.wait_for_end(), "did not read what it was told and was killed");
}

}  // namespace
}  // namespace hyades::worker
