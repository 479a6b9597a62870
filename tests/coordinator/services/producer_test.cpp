#include "coordinator/services/producer.h"

#include <gtest/gtest.h>

#include "hyades/v1/common.pb.h"

namespace hyades::coordinator {
namespace {

/// Whoever wakes it may do so as soon as it is told of it, which is before the stream is made.
class Woken : public Producer<v1::Chunk> {
 protected:
  Woken() { poker()->poke(); }
};

class Counting final : public Woken {
 public:
  using Woken::poker;
  int asked = 0;

 private:
  Step next(v1::Chunk&, grpc::Status&) override {
    ++asked;
    return Step::wait;
  }
};

TEST(Producer, IsNotAskedBeforeItBegins) {
  Counting stream;  // a stream that is asked here calls a pure virtual function
  stream.poker()->poke();
  EXPECT_EQ(stream.asked, 0);
  stream.begin();
  EXPECT_EQ(stream.asked, 1);
  stream.poker()->poke();
  EXPECT_EQ(stream.asked, 2);
}

}  // namespace
}  // namespace hyades::coordinator
