#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "core/base/hash.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "hyades/v1/jobs.grpc.pb.h"
#include "tests/support/temp_folder.h"

extern char** environ;

namespace hyades::bench {

[[noreturn]] inline void give_up(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::exit(1);
}

/// CPU seconds of a process and its threads so far, from /proc.
inline double cpu_seconds(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  std::istringstream fields(line.substr(line.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0;
  double system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// A real coordinator: the program beside this one, in a folder, on a free port of loopback.
/// Killed with the object.
class CoordinatorProcess {
 public:
  /// Begins; how long until it can be reached is what address() waits for.
  explicit CoordinatorProcess(const std::string& folder) : folder_(folder) {
    char path[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    std::string program(path, length > 0 ? static_cast<size_t>(length) : 0);
    program = program.substr(0, program.rfind('/') + 1) + "hyades-coordinator";
    std::vector<std::string> words{program,  "coordinator", "--http",   "off",
                                   "--data", folder,        "--listen", "127.0.0.1:0"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::remove((folder + "/address").c_str());
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ) !=
        0) {
      give_up("cannot start " + program + ": build it first");
    }
    posix_spawn_file_actions_destroy(&actions);
  }
  ~CoordinatorProcess() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  CoordinatorProcess(const CoordinatorProcess&) = delete;
  CoordinatorProcess& operator=(const CoordinatorProcess&) = delete;

  pid_t process() const { return process_; }

  /// HOST:PORT, once it listens.
  std::string address() const {
    for (int i = 0; i < 60'000; ++i) {
      std::ifstream file(folder_ + "/address");
      std::string text;
      if (std::getline(file, text) && !file.eof()) return text;
      if (::waitpid(process_, nullptr, WNOHANG) != 0) give_up("the coordinator has ended");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    give_up("the coordinator does not start");
  }

  std::shared_ptr<grpc::Channel> connect() const {
    farm::Peer peer;
    peer.address = address();
    return *farm::connect(peer);
  }

 private:
  const std::string folder_;
  pid_t process_ = 0;
};

/// Uploads the document and submits it; the job's id.
inline uint64_t submit(const std::shared_ptr<grpc::Channel>& channel, const std::string& document) {
  const auto must = [](const grpc::Status& status) {
    if (!status.ok()) give_up(status.error_message());
  };
  const auto call = [] {
    auto context = std::make_unique<grpc::ClientContext>();
    farm::prepare(*context, {}, std::chrono::seconds(20));
    context->set_wait_for_ready(true);
    return context;
  };
  v1::UploadPart part;
  part.set_sha256(farm::to_wire(core::sha256(document)));
  part.set_size(document.size());
  part.mutable_chunk()->set_data(document);
  v1::UploadResponse uploaded;
  const auto upload_call = call();
  const auto writer = v1::Assets::NewStub(channel)->Upload(upload_call.get(), &uploaded);
  writer->Write(part);
  writer->WritesDone();
  must(writer->Finish());

  v1::SubmitRequest request;
  v1::JobFile& file = *request.mutable_spec()->add_files();
  file.set_path("job.yaml");
  file.set_sha256(part.sha256());
  file.set_size(part.size());
  request.mutable_spec()->set_document("job.yaml");
  v1::SubmitResponse submitted;
  const auto submit_call = call();
  must(v1::Jobs::NewStub(channel)->Submit(submit_call.get(), request, &submitted));
  return submitted.job().id();
}

}  // namespace hyades::bench
