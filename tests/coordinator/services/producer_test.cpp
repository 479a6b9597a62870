#include "coordinator/services/producer.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include <new>
#include <thread>

#include "farm/wire.h"
#include "hyades/v1/assets.grpc.pb.h"

namespace hyades::coordinator {
namespace {

/// Whoever wakes it may do so as soon as it is told of it, which is before the stream is made.
class Woken : public Producer<v1::Chunk> {
 protected:
  Woken(grpc::CallbackServerContext& context, farm::ThreadPool& pool) : Producer(context, pool) {
    waker()->wake();
  }
};

class Counting final : public Woken {
 public:
  using Woken::waker;
  Counting(grpc::CallbackServerContext& context, farm::ThreadPool& pool) : Woken(context, pool) {}
  int asked = 0;

 private:
  Step next(v1::Chunk&, grpc::Status&, bool) override {
    ++asked;
    return Step::wait;
  }
};

class NoCall final : public OutgoingCall {
 public:
  void write(const grpc::ByteBuffer&) override {}
  void finish(const grpc::Status&) override {}
};

TEST(Producer, IsNotAskedBeforeItBegins) {
  grpc::CallbackServerContext context;
  farm::ThreadPool pool(1, 1);
  Counting stream(context, pool);  // a stream that is asked here calls a pure virtual function
  stream.waker()->wake();
  EXPECT_EQ(stream.asked, 0);
  NoCall call;
  stream.begin(call);
  EXPECT_EQ(stream.asked, 1);
  stream.waker()->wake();
  EXPECT_EQ(stream.asked, 2);
}

/// 64 MiB for anybody, of whom it expects to take something every 200 ms.
class Chunks final : public Producer<v1::Chunk> {
 public:
  Chunks(grpc::CallbackServerContext& context, farm::ThreadPool& pool, bool hungry)
      : Producer(context, pool, std::chrono::milliseconds(200)), hungry_(hungry) {}

 private:
  Step next(v1::Chunk& chunk, grpc::Status&, bool) override {
    if (hungry_ && sent_ == 2) throw std::bad_alloc();
    if (++sent_ > 64) return Step::end;
    chunk.set_data(std::string(farm::kMaxChunkBytes, 'x'));
    return Step::message;
  }
  const bool hungry_;  ///< finds no memory for its third message
  int sent_ = 0;
};

class ChunkCall final : public grpc::ServerWriteReactor<grpc::ByteBuffer>, public OutgoingCall {
 public:
  explicit ChunkCall(OutgoingStream* stream) : stream_(stream) { stream_->begin(*this); }
  void OnWriteDone(bool ok) override { stream_->written(ok); }
  void OnCancel() override { stream_->cancel(); }
  void OnDone() override {
    stream_->end();
    delete this;
  }
  void write(const grpc::ByteBuffer& message) override { StartWrite(&message); }
  void finish(const grpc::Status& status) override { Finish(status); }

 private:
  OutgoingStream* const stream_;
};

class ChunkService final : public v1::Assets::WithRawCallbackMethod_Download<v1::Assets::Service> {
 public:
  grpc::ServerWriteReactor<grpc::ByteBuffer>* Download(grpc::CallbackServerContext* context,
                                                       const grpc::ByteBuffer*) override {
    return new ChunkCall(new Chunks(*context, pool_, hungry));
  }
  bool hungry = false;

 private:
  farm::ThreadPool pool_{1, 1};
};

TEST(Producer, BreaksOffWhereNobodyReads) {
  ChunkService service;
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&service);
  const auto server = builder.BuildAndStart();
  const auto stub = v1::Assets::NewStub(
      grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
  for (const bool reads : {true, false}) {
    grpc::ClientContext context;
    const auto reader = stub->Download(&context, {});
    v1::Chunk chunk;
    int come = 0;
    while (reader->Read(&chunk)) {
      if (!reads && come == 0) std::this_thread::sleep_for(std::chrono::seconds(1));
      ++come;
    }
    const grpc::Status status = reader->Finish();
    EXPECT_EQ(status.ok(), reads) << status.error_message();
    EXPECT_EQ(come == 64, reads) << come;
  }
}

TEST(Producer, EndsAloneWhereThereIsNoMemory) {
  ChunkService service;
  service.hungry = true;
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&service);
  const auto server = builder.BuildAndStart();
  const auto stub = v1::Assets::NewStub(
      grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
  for (int i = 0; i < 2; ++i) {
    grpc::ClientContext context;
    const auto reader = stub->Download(&context, {});
    v1::Chunk chunk;
    int come = 0;
    while (reader->Read(&chunk)) ++come;
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_EQ(come, 2);
  }
}

}  // namespace
}  // namespace hyades::coordinator
