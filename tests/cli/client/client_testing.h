#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/client/failure.h"
#include "cli/client/fetch.h"
#include "cli/client/patience.h"
#include "cli/client_commands.h"
#include "core/base/hash.h"
#include "farm/wire.h"
#include "tests/cli/client/fake_farm.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TempFolder;

struct Ran {
  int status = -1;
  std::string out;
  std::string err;
};

using Command = int (*)(int, char**);

inline Ran run(Command command, std::vector<std::string> words) {
  words.insert(words.begin(), "command");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Ran ran;
  ran.status = command(static_cast<int>(argv.size()), argv.data());
  std::fflush(nullptr);
  ran.out = ::testing::internal::GetCapturedStdout();
  ran.err = ::testing::internal::GetCapturedStderr();
  return ran;
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::string read_file(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline std::string digest_of(const std::string& bytes) {
  return farm::to_wire(core::sha256(std::string_view(bytes)));
}

inline v1::WatchEvent event(v1::JobState state, uint64_t samples_done,
                            const std::string& reason = "") {
  v1::WatchEvent event;
  v1::Job& job = *event.mutable_job();
  job.set_id(1);
  job.set_name("tri");
  job.set_frames(2);
  job.set_state(state);
  job.set_samples(100);
  job.set_samples_done(samples_done);
  job.set_reason(reason);
  return event;
}

class Client : public ::testing::Test {
 protected:
  Client() {
    mesh_ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + std::string(3'000'000, '#') + "\n";
    fs::create_directories(folder_.file("m"));
    std::ofstream(folder_.file("m/tri.obj")) << mesh_;
    std::ofstream(folder_.file("job.yaml"))
        << "hyades: 1\nname: tri\nframes: {range: 1-10}\nobjects: {a: {mesh: m/tri.obj}}\n"
           "outputs: [{file: tri.####.exr}]\n";
  }

  /// The command's words and where the farm is.
  std::vector<std::string> at(std::vector<std::string> words) const {
    words.insert(words.end(), {"--coordinator", farm_.address()});
    return words;
  }
  Ran submit(std::vector<std::string> words = {}) const {
    words.insert(words.begin(), folder_.file("job.yaml"));
    return run(submit_command, at(words));
  }
  void add_job(const std::string& name, v1::JobState state = v1::JOB_STATE_RUNNING) {
    v1::Job job;
    job.set_id(farm_.jobs.size() + 1);
    job.set_name(name);
    job.set_owner("ann");
    job.set_state(state);
    farm_.jobs.push_back(job);
  }

  TempFolder folder_;
  std::string mesh_;
  FakeFarm farm_;
};

}  // namespace hyades::cli
