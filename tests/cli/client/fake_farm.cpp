#include "tests/cli/client/fake_farm.h"

#include <grpcpp/server_builder.h>

#include <algorithm>
#include <chrono>

#include "core/base/hash.h"
#include "core/film/film_codec.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::cli {

using grpc::ServerContext;
using grpc::Status;
using grpc::StatusCode;

namespace {

/// What makes a page of an endless list long.
const std::string kPadding(100'000, 'x');

}  // namespace

struct FakeFarm::JobsService : v1::Jobs::Service {
  explicit JobsService(FakeFarm& owner) : farm(owner) {}

  Status Submit(ServerContext* context, const v1::SubmitRequest* request,
                v1::SubmitResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    if (farm.forget_files > 0) {
      --farm.forget_files;
      farm.files.clear();
    }
    v1::ErrorDetail detail;
    for (const v1::JobFile& file : request->spec().files()) {
      if (!farm.files.contains(file.sha256())) detail.add_missing(file.sha256());
    }
    if (detail.missing_size() > 0) {
      return farm::wire_status(StatusCode::FAILED_PRECONDITION, "files are missing", detail);
    }
    farm.submitted.push_back(*request);
    v1::Job job;
    job.set_id(farm.jobs.size() + 1);
    job.set_name(request->spec().name());
    job.set_owner(request->owner());
    job.set_priority(request->priority());
    job.set_state(v1::JOB_STATE_RUNNING);
    job.set_frames(1);
    farm.jobs.push_back(job);
    *response->mutable_job() = job;
    return Status::OK;
  }

  Status List(ServerContext* context, const v1::ListJobsRequest* request,
              v1::ListJobsResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    if (farm.packs) context->set_compression_algorithm(GRPC_COMPRESS_GZIP);
    if (farm.endless) {
      response->add_jobs()->set_reason(kPadding);
      response->set_next_before(request->before() - 1);
      return Status::OK;
    }
    if (farm.turns) {
      response->add_jobs()->set_id(7);
      response->set_next_before(7);
      return Status::OK;
    }
    const int page = request->limit() != 0 ? static_cast<int>(request->limit())
                                           : 2;  // small, so that paging is tried
    for (auto job = farm.jobs.rbegin(); job != farm.jobs.rend(); ++job) {
      if (request->before() != 0 && job->id() >= request->before()) continue;
      if (!request->ended() && job->state() > v1::JOB_STATE_PAUSED) continue;
      if (!request->owner().empty() && job->owner() != request->owner()) continue;
      if (response->jobs_size() == page) {
        response->set_next_before(response->jobs(page - 1).id());
        break;
      }
      *response->add_jobs() = *job;
    }
    return Status::OK;
  }

  Status Get(ServerContext* context, const v1::GetJobRequest* request,
             v1::GetJobResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    *response->mutable_job() = *job;
    for (const v1::Frame& frame : farm.frames) *response->add_frames() = frame;
    response->set_more(farm.turns);
    if (farm.endless) {
      v1::Frame& frame = *response->add_frames();
      frame.set_frame(request->after() + 1);
      frame.set_reason(kPadding);
      response->set_more(true);
    }
    return Status::OK;
  }

  Status Watch(ServerContext* context, const v1::WatchRequest* request,
               grpc::ServerWriter<v1::WatchEvent>* writer) override {
    std::unique_lock lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    for (size_t i = 0; i < farm.events.size(); ++i) {
      const v1::WatchEvent event = farm.events[i];
      lock.unlock();
      if (farm.before_event) farm.before_event(i);
      writer->Write(event);
      lock.lock();
      if (breaks()) return {StatusCode::UNAVAILABLE, "broken"};
    }
    return Status::OK;
  }

  Status Film(ServerContext* context, const v1::FilmRequest* request,
              grpc::ServerWriter<v1::FilmPart>* writer) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    const auto found = farm.films.find(request->frame());
    if (found == farm.films.end()) {
      return {StatusCode::FAILED_PRECONDITION, "the film is kept no more"};
    }
    const std::vector<std::byte> bytes = core::encode_film(found->second);
    v1::FilmPart part;
    part.mutable_header()->set_frame(request->frame());
    part.mutable_header()->set_size(farm.endless ? UINT64_MAX : bytes.size());
    writer->Write(part);
    part.mutable_chunk()->set_data(bytes.data(), bytes.size());
    writer->Write(part);
    return Status::OK;
  }

  Status change(ServerContext* context, const v1::JobRequest* request, v1::JobResponse* response,
                v1::JobState state) {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    job->set_state(state);
    *response->mutable_job() = *job;
    return Status::OK;
  }
  Status Pause(ServerContext* c, const v1::JobRequest* q, v1::JobResponse* r) override {
    return change(c, q, r, v1::JOB_STATE_PAUSED);
  }
  Status Resume(ServerContext* c, const v1::JobRequest* q, v1::JobResponse* r) override {
    return change(c, q, r, v1::JOB_STATE_RUNNING);
  }
  Status Cancel(ServerContext* c, const v1::JobRequest* q, v1::JobResponse* r) override {
    return change(c, q, r, v1::JOB_STATE_CANCELLED);
  }
  Status Retry(ServerContext* c, const v1::JobRequest* q, v1::JobResponse* r) override {
    return change(c, q, r, v1::JOB_STATE_RUNNING);
  }

  Status SetPriority(ServerContext* context, const v1::SetPriorityRequest* request,
                     v1::JobResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    job->set_priority(request->priority());
    *response->mutable_job() = *job;
    return Status::OK;
  }

  Status Delete(ServerContext* context, const v1::JobRequest* request,
                v1::DeleteJobResponse*) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    if (job->state() <= v1::JOB_STATE_PAUSED) {
      return {StatusCode::FAILED_PRECONDITION, "the job has not ended"};
    }
    std::erase_if(farm.jobs, [&](const v1::Job& j) { return j.id() == request->job(); });
    return Status::OK;
  }

  Status Outputs(ServerContext* context, const v1::OutputsRequest* request,
                 grpc::ServerWriter<v1::OutputFile>* writer) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    v1::Job* job = nullptr;
    if (Status s = farm.find(request->job(), job); !s.ok()) return s;
    for (const auto& [path, bytes] : farm.outputs) {
      v1::OutputFile file;
      file.set_path(path);
      file.set_frame(farm.frame_of_outputs);
      file.set_size(bytes.size());
      file.set_sha256(farm::to_wire(core::sha256(std::string_view(bytes))));
      writer->Write(file);
    }
    return Status::OK;
  }

  Status Fetch(ServerContext* context, const v1::FetchRequest* request,
               grpc::ServerWriter<v1::Chunk>* writer) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    const auto found = farm.outputs.find(request->path());
    if (found == farm.outputs.end()) return {StatusCode::NOT_FOUND, "no such file"};
    constexpr size_t kPiece = 1000;
    for (size_t at = request->offset(); at < found->second.size(); at += kPiece) {
      v1::Chunk chunk;
      chunk.set_offset(at);
      chunk.set_data(found->second.substr(at, kPiece));
      if (farm.damage_fetch) chunk.mutable_data()->assign(chunk.data().size(), '?');
      farm.fetched += chunk.data().size();
      writer->Write(chunk);
      if (breaks()) return {StatusCode::UNAVAILABLE, "broken"};
    }
    return Status::OK;
  }

  Status ListTimeline(ServerContext* context, const v1::ListTimelineRequest* request,
                      v1::ListTimelineResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    constexpr int kPage = 700;
    for (int i = 1; farm.endless_steps && i <= kPage; ++i) {
      v1::TimelineStep& step = *response->add_steps();
      step.set_number(request->after() + static_cast<uint64_t>(i));
      step.set_kind(v1::TimelineStep::KIND_RENDER);
      step.set_worker(std::to_string(step.number()) + kPadding.substr(0, 2000));
      response->set_more(true);
    }
    if (farm.same_steps) {
      response->add_steps()->set_number(1);
      response->set_more(true);
      return Status::OK;
    }
    for (const v1::TimelineStep& step : farm.steps) {
      if (step.number() <= request->after()) continue;
      response->set_more(response->steps_size() == kPage);
      if (response->more()) break;
      *response->add_steps() = step;
    }
    response->set_dropped(farm.dropped_steps);
    return Status::OK;
  }

  Status Logs(ServerContext* context, const v1::LogsRequest* request,
              grpc::ServerWriter<v1::LogLine>* writer) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    for (int i = 1; i <= 3; ++i) {
      v1::LogLine line;
      line.set_level(v1::LOG_LEVEL_WARNING);
      line.set_of_frame(true);
      line.set_frame(i);
      line.set_text("line " + std::to_string(i) + "\033[2J");
      line.set_number(static_cast<uint64_t>(10 * i));
      if (line.number() <= request->after()) continue;
      writer->Write(line);
      if (breaks()) return {StatusCode::UNAVAILABLE, "broken"};
    }
    return Status::OK;
  }

  Status Explain(ServerContext* context, const v1::JobRequest*,
                 v1::ExplainResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    response->add_reasons("no workers");
    return Status::OK;
  }

  bool breaks() const { return farm.break_streams > 0 && farm.break_streams-- > 0; }

  FakeFarm& farm;
};

struct FakeFarm::AssetsService : v1::Assets::Service {
  explicit AssetsService(FakeFarm& owner) : farm(owner) {}

  Status FindMissing(ServerContext* context, const v1::FindMissingRequest* request,
                     v1::FindMissingResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    for (const v1::JobFile& file : request->files()) {
      if (farm.files.contains(file.sha256())) continue;
      auto& missing = *response->add_missing();
      missing.set_sha256(file.sha256());
      missing.set_offset(farm.partial[file.sha256()].size());
      if (farm.asks_twice) *response->add_missing() = missing;
    }
    return Status::OK;
  }

  Status Upload(ServerContext* context, grpc::ServerReader<v1::UploadPart>* reader,
                v1::UploadResponse*) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    if (farm.no_uploads) return {StatusCode::UNAVAILABLE, "not now"};
    v1::UploadPart part;
    std::string digest;
    uint64_t size = 0;
    while (reader->Read(&part)) {
      if (digest.empty()) {
        digest = part.sha256();
        size = part.size();
      }
      std::string& bytes = farm.partial[digest];
      if (farm.lose_partial && !part.sha256().empty() && part.chunk().offset() > 0) {
        farm.lose_partial = false;
        bytes.clear();
        return {StatusCode::OUT_OF_RANGE, "bytes from 0 on are missing"};
      }
      if (part.chunk().offset() != bytes.size()) return {StatusCode::INVALID_ARGUMENT, "offset"};
      std::string data = part.chunk().data();
      if (farm.damage_upload && !data.empty()) {
        data[0] = static_cast<char>(data[0] ^ 1);
        farm.damage_upload = false;
      }
      farm.uploaded += data.size();
      if (farm.upload_cut != 0 && bytes.size() + data.size() >= farm.upload_cut) {
        bytes += data.substr(0, farm.upload_cut - bytes.size());
        farm.upload_cut = 0;
        return {StatusCode::UNAVAILABLE, "broken"};
      }
      bytes += data;
    }
    const std::string bytes = farm.partial[digest];
    if (bytes.size() < size) return {StatusCode::UNAVAILABLE, "cut off"};
    farm.partial.erase(digest);
    if (farm::to_wire(core::sha256(std::string_view(bytes))) != digest) {
      return {StatusCode::DATA_LOSS, "not the named bytes"};
    }
    farm.files[digest] = bytes;
    return Status::OK;
  }

  FakeFarm& farm;
};

struct FakeFarm::FarmService : v1::Farm::Service {
  explicit FarmService(FakeFarm& owner) : farm(owner) {}

  Status Workers(ServerContext* context, const v1::WorkersRequest* request,
                 v1::WorkersResponse* response) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    if (farm.endless) {
      response->add_workers()->set_reason(kPadding);
      response->set_next_after(request->after() + 1);
    }
    for (const v1::Worker& worker : farm.workers) *response->add_workers() = worker;
    return Status::OK;
  }

  Status change(ServerContext* context, const v1::WorkerRequest* request,
                v1::WorkerResponse* response, v1::WorkerState state) {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    for (v1::Worker& worker : farm.workers) {
      if (worker.name() != request->worker()) continue;
      worker.set_state(state);
      worker.set_reason(request->reason());
      *response->mutable_worker() = worker;
      return Status::OK;
    }
    return {StatusCode::NOT_FOUND, "there is no worker '" + request->worker() + "'"};
  }
  Status DrainWorker(ServerContext* c, const v1::WorkerRequest* q, v1::WorkerResponse* r) override {
    return change(c, q, r, v1::WORKER_STATE_DRAINING);
  }
  Status QuarantineWorker(ServerContext* c, const v1::WorkerRequest* q,
                          v1::WorkerResponse* r) override {
    return change(c, q, r, v1::WORKER_STATE_QUARANTINED);
  }
  Status ReleaseWorker(ServerContext* c, const v1::WorkerRequest* q,
                       v1::WorkerResponse* r) override {
    return change(c, q, r, v1::WORKER_STATE_ACTIVE);
  }

  FakeFarm& farm;
};

struct FakeFarm::AdminService : v1::Admin::Service {
  explicit AdminService(FakeFarm& owner) : farm(owner) {}

  Status Audit(ServerContext* context, const v1::AuditRequest*,
               grpc::ServerWriter<v1::AuditEntry>* writer) override {
    const std::lock_guard lock(farm.mutex_);
    if (Status s = farm.enter(*context); !s.ok()) return s;
    for (const v1::AuditEntry& entry : farm.audited) writer->Write(entry);
    return Status::OK;
  }

  FakeFarm& farm;
};

FakeFarm::FakeFarm()
    : jobs_service_(std::make_unique<JobsService>(*this)),
      assets_service_(std::make_unique<AssetsService>(*this)),
      farm_service_(std::make_unique<FarmService>(*this)),
      admin_service_(std::make_unique<AdminService>(*this)) {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
  builder.RegisterService(jobs_service_.get());
  builder.RegisterService(assets_service_.get());
  builder.RegisterService(farm_service_.get());
  builder.RegisterService(admin_service_.get());
  server_ = builder.BuildAndStart();
}

FakeFarm::~FakeFarm() {
  if (server_) server_->Shutdown(std::chrono::system_clock::now());
}

Status FakeFarm::enter(const ServerContext& context) {
  ++calls;
  const auto& metadata = context.client_metadata();
  if (metadata.find(farm::kProtocolKey) == metadata.end()) {
    return {StatusCode::FAILED_PRECONDITION, "no protocol version"};
  }
  if (!token.empty()) {
    const auto found = metadata.find(farm::kTokenKey);
    if (found == metadata.end() || found->second != "Bearer " + token) {
      return {StatusCode::UNAUTHENTICATED, "the farm's token is another"};
    }
  }
  if (unavailable > 0) {
    --unavailable;
    return {StatusCode::UNAVAILABLE, "starting"};
  }
  if (full > 0) {
    --full;
    return {StatusCode::RESOURCE_EXHAUSTED, full_words};
  }
  return Status::OK;
}

Status FakeFarm::find(uint64_t id, v1::Job*& job) {
  for (v1::Job& one : jobs) {
    if (one.id() == id) job = &one;
  }
  return job != nullptr ? Status::OK
                        : Status(StatusCode::NOT_FOUND, "there is no job " + std::to_string(id));
}

}  // namespace hyades::cli
