#include "worker/renderer_talk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace hyades::worker {
namespace {

using FromRenderer = pipe::FromRenderer;

FromRenderer ready() {
  FromRenderer message;
  message.mutable_ready()->set_worker_class("class");
  return message;
}

FromRenderer not_ready() {
  FromRenderer message;
  message.mutable_not_ready()->set_reason("no");
  return message;
}

FromRenderer film(uint32_t batches = 1) {
  FromRenderer message;
  message.mutable_film()->set_batches(batches);
  message.mutable_film()->set_digest(std::string(32, 'd'));
  return message;
}

/// What is wrong with the last of `messages`; the others are sound.
std::string wrong_with(std::vector<FromRenderer> messages, const std::string& load = {}) {
  RendererTalk talk;
  std::string wrong;
  for (size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(wrong, "");
    const auto heard = talk.hear(messages[i], i + 1 == messages.size() ? load : std::string());
    wrong = heard ? "" : heard.error().message;
  }
  return wrong;
}

/// A unit whose file breaks the renderer could end one worker after the other with it.
TEST(RendererTalk, WhetherItIsReadyIsSaidFirstAndOnce) {
  FromRenderer started;
  started.mutable_started()->set_token(1);
  EXPECT_EQ(wrong_with({ready()}), "");
  EXPECT_EQ(wrong_with({not_ready()}), "");
  EXPECT_EQ(wrong_with({ready(), started}), "");
  EXPECT_EQ(wrong_with({ready(), started, not_ready()}), "said twice whether it is ready");
  EXPECT_EQ(wrong_with({ready(), ready()}), "said twice whether it is ready");
  EXPECT_EQ(wrong_with({started}), "spoke before it was ready");
  EXPECT_EQ(wrong_with({FromRenderer()}), "spoke before it was ready");
  EXPECT_EQ(wrong_with({ready(), FromRenderer()}), "said nothing that is known");
}

TEST(RendererTalk, FilmsHaveWhatFilmsHave) {
  EXPECT_EQ(wrong_with({ready(), film()}, "bytes"), "");
  EXPECT_EQ(wrong_with({ready(), film()}), "sent a film without bytes");
  EXPECT_EQ(wrong_with({ready(), film(0)}, "bytes"), "sent a film of no batches");
  FromRenderer short_digest = film();
  short_digest.mutable_film()->set_digest("d");
  EXPECT_EQ(wrong_with({ready(), short_digest}, "bytes"), "sent a film without a digest");
  FromRenderer talkative = film();
  for (int i = 0; i < 17; ++i) talkative.mutable_film()->add_notes("a note");
  EXPECT_EQ(wrong_with({ready(), talkative}, "bytes"), "sent a film with too many notes");
  FromRenderer started;
  started.mutable_started()->set_token(1);
  EXPECT_EQ(wrong_with({ready(), started}, "bytes"), "sent bytes that are no film");
}

/// Memory for what was announced would be taken by a word.
TEST(RendererTalk, LengthsBeyondTheLimitsAreRefusedAndOthersTakeNoMemoryBeforeTheyCome) {
  const auto read_from = [](std::string_view bytes, std::string& load, size_t& asked) {
    FromRenderer message;
    return pipe::read_message(
        [&](char* to, size_t size) {
          asked = std::max(asked, size);
          const size_t count = std::min(size, bytes.size());
          std::copy_n(bytes.begin(), count, to);
          bytes.remove_prefix(count);
          return count;
        },
        renderer_limits(), message, load);
  };
  std::string load;
  size_t asked = 0;
  const std::string whole = pipe::frame_message(film(), std::string(3'000'000, 'f'));
  EXPECT_TRUE(*read_from(whole, load, asked));
  EXPECT_EQ(load, std::string(3'000'000, 'f'));
  EXPECT_FALSE(*read_from(std::string_view(whole).substr(0, 2'000'000), load, asked)) << "cut off";
  EXPECT_FALSE(*read_from("", load, asked));
  std::string long_message = whole;
  long_message[3] = 0x10;
  EXPECT_EQ(read_from(long_message, load, asked).error().message, "sent more than any message has");
  std::string long_load = whole;
  long_load[7] = 0x20;
  EXPECT_EQ(read_from(long_load, load, asked).error().message, "sent more than any message has");
  std::string large_load = whole;
  large_load[7] = 0x0F;  // 250 MiB, as a film may have; 3 MB come
  EXPECT_FALSE(*read_from(large_load, load, asked));
  EXPECT_LE(asked, size_t{1} << 20U);
  EXPECT_LE(load.capacity(), size_t{16} << 20U);
  EXPECT_EQ(read_from(std::string("\1\0\0\0\0\0\0\0\xFF", 9), load, asked).error().message,
            "sent what is no message");
}

}  // namespace
}  // namespace hyades::worker
