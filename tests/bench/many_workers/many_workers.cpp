// Many light-weight workers on one coordinator, over real gRPC, each with a connection of its own:
//
//   bench_many_workers ADDRESS WORKERS SECONDS [SECONDS-PER-SAMPLE [TOKEN-FILE [CA-FILE]]]
//
// A job of one layer and 4,096 samples must be there (tests/bench/many_workers/run makes all).
// Prints a line each five seconds: how many are connected, units per second, and how long leases
// and acknowledgements took.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/film/film.h"
#include "farm/channel.h"
#include "tests/bench/many_workers/light_worker.h"

namespace {

using namespace hyades;

std::string content(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::shared_ptr<grpc::Channel> connection(const std::string& address, const std::string& ca_file) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // else all would share one connection
  arguments.SetMaxReceiveMessageSize(-1);
  auto credentials = grpc::InsecureChannelCredentials();
  if (!ca_file.empty()) {
    grpc::SslCredentialsOptions options;
    options.pem_root_certs = content(ca_file);
    credentials = grpc::SslCredentials(options);
  }
  return grpc::CreateCustomChannel(address, credentials, arguments);
}

void print(const char* name, const bench::Latencies::Summary& s) {
  std::printf("  %s %6zu  p50 %7.1f  p90 %7.1f  p99 %7.1f  most %7.1f ms", name, s.count, s.p50,
              s.p90, s.p99, s.most);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(
        stderr,
        "many_workers ADDRESS WORKERS SECONDS [SECONDS-PER-SAMPLE [TOKEN-FILE [CA-FILE]]]\n");
    return 2;
  }
  const std::string address = arguments[1];
  const int workers = std::atoi(arguments[2]);
  const double seconds = std::atof(arguments[3]);
  const auto token = farm::read_token(count > 5 ? arguments[5] : "");
  if (!token) {
    std::fprintf(stderr, "%s\n", token.error().message.c_str());
    return 2;
  }
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &files);

  bench::Timer timer(2);
  bench::Timer beats(1);
  bench::Crowd crowd{timer, beats, core::make_film_layout({}), 4096,
                     count > 4 ? std::atof(arguments[4]) : 1e-5};
  std::vector<std::unique_ptr<bench::LightWorker>> all;
  for (int i = 0; i < workers; ++i) {
    all.push_back(std::make_unique<bench::LightWorker>(
        crowd, connection(address, count > 6 ? arguments[6] : ""), *token, i));
  }
  uint64_t before = 0;
  double worst_p99 = 0;  // of the second half: at first all come at once
  for (double at = 0; at < seconds; at += 5) {
    std::this_thread::sleep_for(std::chrono::seconds(5));
    const uint64_t units = crowd.acknowledged;
    std::printf("%4.0f s  connected %5llu  %6.1f units/s", at + 5,
                static_cast<unsigned long long>(crowd.welcomed - crowd.ended),
                static_cast<double>(units - before) / 5);
    before = units;
    const auto leases = crowd.lease.take();
    if (2 * at >= seconds) worst_p99 = std::max(worst_p99, leases.p99);
    print("leases", leases);
    print("acknowledged", crowd.acknowledgement.take());
    std::printf("  rejected %llu\n", static_cast<unsigned long long>(crowd.rejected.load()));
    std::fflush(stdout);
  }
  std::string trouble;
  if (crowd.welcomed - crowd.ended != static_cast<uint64_t>(workers)) trouble = "not all connected";
  if (crowd.rejected > 0) trouble = "films were rejected";
  if (worst_p99 >= 100) trouble = "leases took longer than 100 ms";
  for (const auto& worker : all) {
    if (trouble.empty()) trouble = worker->trouble();
  }
  if (!trouble.empty()) std::printf("trouble: %s\n", trouble.c_str());
  timer.stop();
  beats.stop();
  for (const auto& worker : all) worker->leave();
  for (const auto& worker : all) {
    while (!worker->done()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return trouble.empty() ? 0 : 1;
}
