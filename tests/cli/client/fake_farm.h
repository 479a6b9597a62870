#pragma once

#include <grpcpp/server.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/film/film.h"
#include "hyades/v1/admin.grpc.pb.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "hyades/v1/farm.grpc.pb.h"
#include "hyades/v1/jobs.grpc.pb.h"

namespace hyades::cli {

/// A coordinator that renders nothing: it keeps what it is sent, tells what a test has written into
/// it, and fails where the test asks for it. Listens on the loopback interface.
class FakeFarm {
 public:
  FakeFarm();
  ~FakeFarm();

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  // Written by tests before they call, read afterwards.
  std::string token;                           ///< that calls must carry; empty: none
  std::map<std::string, std::string> files;    ///< assets by digest (32 bytes)
  std::map<std::string, std::string> partial;  ///< what has come of others
  std::vector<v1::Job> jobs;                   ///< oldest first
  std::vector<v1::Frame> frames;               ///< of every job
  std::vector<v1::WatchEvent> events;          ///< of Watch
  std::function<void(size_t)> before_event;    ///< called before each, with its number
  std::map<int32_t, core::Film> films;         ///< of frames, of every job
  std::map<std::string, std::string> outputs;  ///< by path
  std::vector<v1::TimelineStep> steps;         ///< of every job
  uint64_t dropped_steps = 0;
  int32_t frame_of_outputs = 0;
  std::vector<v1::SubmitRequest> submitted;
  std::vector<v1::Worker> workers;
  std::vector<v1::AuditEntry> audited;  ///< oldest first

  int unavailable = 0;  ///< so many calls fail with UNAVAILABLE first
  int full = 0;         ///< so many calls fail with RESOURCE_EXHAUSTED and these words
  std::string full_words;
  int forget_files = 0;       ///< so many times Submit misses all files, which are forgotten
  int break_streams = 0;      ///< so many streams of the server break in the middle
  uint64_t upload_cut = 0;    ///< an upload breaks after so many bytes, once; 0: none
  bool lose_partial = false;  ///< what had come of the next upload's file turns out not to be there
  bool damage_upload = false;  ///< the next upload's first byte arrives damaged
  bool damage_fetch = false;   ///< every fetched byte is wrong
  bool endless = false;        ///< lists have always one more page, films one more byte
  bool packs = false;          ///< answers are compressed
  bool turns = false;          ///< lists have always one more page, which is the same one
  bool endless_steps = false;  ///< always one more page of steps, each of another worker
  bool same_steps = false;     ///< ... of the same one
  bool asks_twice = false;     ///< FindMissing names what is missing twice
  bool no_uploads = false;     ///< Upload fails with UNAVAILABLE, and nothing else does
  int calls = 0;
  uint64_t fetched = 0;  ///< bytes that Fetch has sent
  uint64_t uploaded = 0;

 private:
  struct JobsService;
  struct AssetsService;
  struct FarmService;
  struct AdminService;

  grpc::Status enter(const grpc::ServerContext& context);
  grpc::Status find(uint64_t id, v1::Job*& job);

  std::mutex mutex_;  ///< held by every call
  std::unique_ptr<JobsService> jobs_service_;
  std::unique_ptr<AssetsService> assets_service_;
  std::unique_ptr<FarmService> farm_service_;
  std::unique_ptr<AdminService> admin_service_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
};

}  // namespace hyades::cli
