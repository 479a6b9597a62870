#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "coordinator/access/authority.h"
#include "coordinator/controller/controller.h"
#include "coordinator/services/server.h"
#include "core/base/hash.h"
#include "core/image/read_image.h"
#include "core/job/layers.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "hyades/v1/farm.grpc.pb.h"
#include "hyades/v1/jobs.grpc.pb.h"
#include "tests/coordinator/services/scripted_worker.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {

using namespace std::chrono_literals;

/// What asks for something about the job.
inline v1::JobRequest about(uint64_t job) {
  v1::JobRequest request;
  request.set_job(job);
  return request;
}

/// Waits until `what` holds, a minute at most.
inline bool eventually(const std::function<bool()>& what) {
  for (int i = 0; i < 12'000; ++i) {
    if (what()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

/// A coordinator in this process, over real gRPC, and a client of it.
class FarmWorld {
 public:
  static constexpr int kWidth = 80;
  static constexpr int kHeight = 48;
  static constexpr uint32_t kSamples = 40;

  FarmWorld() {
    options.folder = folder.file("data");
    options.finisher = HYADES_FILM_PROGRAM;
    options.reconnect_time = 200ms;
    options.adoption_time = 200ms;
  }
  ~FarmWorld() { stop(); }

  void start() {
    std::unique_ptr<JobStore> store;
    if (wrap_store) {
      std::filesystem::create_directories(options.folder);
      auto stored = open_sqlite_job_store(options.folder + "/state.db");
      ASSERT_TRUE(stored.ok()) << (stored ? "" : stored.error().message);
      store = wrap_store(std::move(*stored));
    }
    auto opened = Controller::open(options, std::move(store));
    ASSERT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
    controller = std::move(*opened);
    farm::Listen listen = how;
    listen.address = address.empty() ? "127.0.0.1:0" : address;
    auto door = farm::open_door(listen);
    ASSERT_TRUE(door.ok()) << (door ? "" : door.error().message);
    auto known = Authority::open(controller->store(),
                                 {.shared_token = door->token, .audit_folder = options.folder});
    ASSERT_TRUE(known.ok()) << (known ? "" : known.error().message);
    authority = std::move(*known);
    auto listening = Server::start(*door, *controller, *authority, serving);
    ASSERT_TRUE(listening.ok()) << (listening ? "" : listening.error().message);
    server = std::move(*listening);
    connect(server->address());
  }

  /// The client's side alone, where the coordinator is another process.
  void connect(const std::string& where) {
    address = where;
    farm::Peer peer;
    peer.address = address;
    channel = *farm::connect(peer);
    jobs = v1::Jobs::NewStub(channel);
    assets = v1::Assets::NewStub(channel);
    farm_ = v1::Farm::NewStub(channel);
  }

  /// Orderly; a killed process is for the tests of whole processes.
  void stop() {
    if (controller) controller->stop();
    server.reset();
    authority.reset();
    controller.reset();
  }

  static std::string document(int last_frame) {
    return "hyades: 1\nname: balls\nframes: {range: 1-" + std::to_string(last_frame) +
           "}\nfilm: {size: [80, 48]}\nsampling: {samples: 40}\nenvironment: {color: 1}\n"
           "objects: {ball: {shape: sphere, radius: 1, material: clay}}\n"
           "materials: {clay: {type: lambert, color: 0.5}}\n"
           "outputs: [{file: balls.####.exr}, {file: balls.####.png}]\n";
  }

  std::unique_ptr<grpc::ClientContext> context(std::chrono::milliseconds timeout = 20s) const {
    auto c = std::make_unique<grpc::ClientContext>();
    farm::prepare(*c, token, timeout);
    return c;
  }

  grpc::Status upload(std::string_view text) const {
    v1::UploadResponse response;
    const auto c = context();
    const auto writer = assets->Upload(c.get(), &response);
    v1::UploadPart part;
    part.set_sha256(farm::to_wire(core::sha256(text)));
    part.set_size(text.size());
    constexpr size_t kPart = size_t{1} << 20U;
    for (size_t at = 0; at == 0 || at < text.size(); at += kPart) {
      part.mutable_chunk()->set_offset(at);
      part.mutable_chunk()->set_data(std::string(text.substr(at, kPart)));
      writer->Write(part);
      part.Clear();
    }
    writer->WritesDone();
    return writer->Finish();
  }

  static v1::SubmitRequest request(const std::string& text) {
    v1::SubmitRequest request;
    v1::JobFile& file = *request.mutable_spec()->add_files();
    file.set_path("job.yaml");
    file.set_sha256(farm::to_wire(core::sha256(text)));
    file.set_size(text.size());
    request.mutable_spec()->set_document("job.yaml");
    request.set_owner("ada");
    return request;
  }

  /// Uploads and submits; the job's id.
  uint64_t submit(int last_frame, const std::function<void(v1::SubmitRequest&)>& change = {}) {
    return submit_text(document(last_frame), change);
  }
  uint64_t submit_text(const std::string& text,
                       const std::function<void(v1::SubmitRequest&)>& change = {}) {
    EXPECT_TRUE(upload(text).ok());
    v1::SubmitRequest asked = request(text);
    if (change) change(asked);
    v1::SubmitResponse response;
    const grpc::Status status = jobs->Submit(context().get(), asked, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.job().id();
  }

  v1::GetJobResponse get(uint64_t job) const {
    v1::GetJobRequest request;
    request.set_job(job);
    v1::GetJobResponse response;
    const auto c = context();
    // gRPC may still wait before it tries this address again, where nobody was a moment ago.
    c->set_wait_for_ready(true);
    const grpc::Status status = jobs->Get(c.get(), request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }

  bool wait_for(uint64_t job, v1::JobState state) const {
    return eventually([&] { return get(job).job().state() == state; });
  }

  /// Why the job does or does not get on, a line for each reason.
  std::string explain(uint64_t job) const {
    v1::JobRequest request;
    request.set_job(job);
    v1::ExplainResponse response;
    EXPECT_TRUE(jobs->Explain(context().get(), request, &response).ok());
    std::string all;
    for (const std::string& reason : response.reasons()) all += reason + "\n";
    return all;
  }

  /// The unit as if it had been leased to this worker, too.
  v1::LeasedUnit leased_to(const ScriptedWorker& worker, v1::LeasedUnit unit) const {
    const LeaseProofs proofs(*controller->store().secret());
    unit.mutable_unit()->set_proof(
        proofs.make(worker.id(), JobId{unit.job()}, *farm::from_wire(unit.unit())));
    return unit;
  }

  ScriptedWorker::Script script(int number = 1) const {
    ScriptedWorker::Script script;
    script.id = "scripted-worker-" + std::to_string(1000 + number);
    script.name = "scripted/" + std::to_string(number);
    script.layout = core::make_film_layout({});
    script.samples = kSamples;
    script.token = token;
    return script;
  }

  /// The bytes of a finished file, in two pieces.
  std::string fetch(uint64_t job, const std::string& path) const {
    std::string bytes;
    for (int i = 0; i < 2; ++i) {
      v1::FetchRequest request;
      request.set_job(job);
      request.set_path(path);
      request.set_offset(bytes.size());
      const auto c = context();
      const auto reader = jobs->Fetch(c.get(), request);
      v1::Chunk chunk;
      while (reader->Read(&chunk)) {
        EXPECT_EQ(chunk.offset(), bytes.size());
        bytes += chunk.data();
        if (i == 0) {
          bytes.resize(bytes.size() / 2);
          c->TryCancel();
        }
      }
      const grpc::Status status = reader->Finish();
      EXPECT_TRUE(i == 0 || status.ok()) << status.error_message();
    }
    return bytes;
  }

  /// The pixels of frame `frame` of a job are those of the oracle, to the last bit.
  void expect_truth(uint64_t job, int32_t frame) const {
    expect_picture(job, frame,
                   fake_film({frame, {0, 0, kWidth, kHeight}, {0, core::batch_count(kSamples)}},
                             kSamples, core::make_film_layout({})));
  }

  /// The pixels of frame `frame` of a job are those of `film`, to the last bit.
  void expect_picture(uint64_t job, int32_t frame, const core::Film& film) const {
    char name[32];
    std::snprintf(name, sizeof name, "balls.%04d.exr", frame);
    const std::string path = folder.file(name);
    const std::string bytes = fetch(job, name);
    ASSERT_FALSE(bytes.empty());
    FILE* file = std::fopen(path.c_str(), "wb");
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
    const auto got = core::read_image_file(path);
    ASSERT_TRUE(got.ok()) << got.error().message;
    const core::Image truth = film.normalised();
    ASSERT_EQ(got->width, truth.width);
    ASSERT_EQ(got->height, truth.height);
    for (const char* name_of : {"R", "G", "B"}) {
      const int a = got->find_channel(name_of);
      const int b = truth.find_channel(name_of);
      ASSERT_GE(a, 0);
      for (int y = 0; y < truth.height; ++y) {
        for (int x = 0; x < truth.width; ++x) {
          ASSERT_EQ(got->at(x, y, a), truth.at(x, y, b)) << name_of << " " << x << " " << y;
        }
      }
    }
  }

  test::TempFolder folder;
  ControllerOptions options;
  /// Puts something before the coordinator's job store, to make it fail or wait.
  std::function<std::unique_ptr<JobStore>(std::unique_ptr<JobStore>)> wrap_store;
  farm::Listen how;
  Server::Options serving;
  std::string token;
  std::string address;
  std::unique_ptr<Controller> controller;
  std::unique_ptr<Authority> authority;
  std::unique_ptr<Server> server;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Jobs::Stub> jobs;
  std::unique_ptr<v1::Assets::Stub> assets;
  std::unique_ptr<v1::Farm::Stub> farm_;
};

/// The film of a frame, also one that grows.
inline grpc::Status fetch_film(const FarmWorld& world, uint64_t job, int32_t frame,
                               std::string& bytes) {
  v1::FilmRequest request;
  request.set_job(job);
  request.set_frame(frame);
  const auto context = world.context();
  const auto reader = world.jobs->Film(context.get(), request);
  v1::FilmPart part;
  while (reader->Read(&part)) bytes += part.chunk().data();
  return reader->Finish();
}

}  // namespace hyades::coordinator
