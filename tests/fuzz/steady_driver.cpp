// Drives a fuzz target without feedback, the same way every time: first the files that are named
// (crashes of the past), then the seeds, then changed seeds. The suite runs every target so;
// tests/fuzz/run looks deeper.
//
//   fuzz_NAME [--rounds N] [--from ROUND] [FILE...]
//
// An input that crashes, or takes more than kSeconds, is left in the current folder as
// crash-NAME.

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.h"
#include "tests/support/random.h"

namespace {

constexpr unsigned kSeconds = 60;                 // the machine may be busy
constexpr rlim_t kMostMemory = rlim_t{8} << 30U;  // of addresses; sanitizers need no limit here
constexpr size_t kLongest = size_t{1} << 20U;     // bytes of an input
constexpr size_t kMostSeedBytes = kLongest;       // longer seeds are tried once, unchanged

std::string current;
std::string crash_file;

void leave_input(int signal) {
  const int file = ::open(crash_file.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
  if (file >= 0 && ::write(file, current.data(), current.size()) >= 0) ::close(file);
  const std::string_view text = signal == SIGALRM ? "an input takes too long: " : "a crash: ";
  (void)!::write(STDERR_FILENO, text.data(), text.size());
  (void)!::write(STDERR_FILENO, crash_file.data(), crash_file.size());
  (void)!::write(STDERR_FILENO, "\n", 1);
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

bool try_one(std::string input) {
  current = std::move(input);
  ::alarm(kSeconds);
  const bool taken = hyades::fuzz::try_input(current);
  ::alarm(0);
  return taken;
}

class Changer {
 public:
  explicit Changer(const std::vector<std::string>& seeds) : seeds_(seeds) {}

  std::string changed(uint64_t round) const {
    hyades::test::Random random(round);
    std::string text = pick(random);
    for (uint64_t times = 1 + random.bits() % 5; times > 0; --times) change(text, random);
    if (text.size() > kLongest) text.resize(kLongest);
    return text;
  }

 private:
  const std::string& pick(hyades::test::Random& random) const {
    return seeds_[random.bits() % seeds_.size()];
  }

  void change(std::string& text, hyades::test::Random& random) const {
    static constexpr std::array<uint32_t, 8> kEdges{
        0, 1, 0x7F, 0x80, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU, 0x10000U};
    const auto below = [&](size_t n) { return n == 0 ? 0 : random.bits() % n; };
    if (text.empty()) text = "0";
    const size_t at = below(text.size());
    switch (random.bits() % 9) {
      case 0:
        text[at] = static_cast<char>(random.bits());
        break;
      case 1:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 2:
        text.erase(at, 1 + below(16));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(64)));
        break;
      case 4:
        text.resize(at);
        break;
      case 5: {  // a number of four bytes
        const uint32_t edge = kEdges[below(kEdges.size())];
        for (size_t i = 0; i < 4 && at + i < text.size(); ++i) {
          text[at + i] = static_cast<char>(edge >> (8 * i));
        }
        break;
      }
      case 6: {  // digits
        size_t begin = at;
        while (begin < text.size() && (text[begin] < '0' || text[begin] > '9')) ++begin;
        size_t end = begin;
        while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
        static constexpr std::array<const char*, 7> kNumbers{
            "0", "-1", "4294967296", "99999999999999999999", "1e38", "nan", "1e-45"};
        text.replace(begin, end - begin, kNumbers[below(kNumbers.size())]);
        break;
      }
      case 7: {  // the rest of another
        const std::string& other = pick(random);
        text.replace(at, std::string::npos, other.substr(below(other.size() + 1)));
        break;
      }
      default:
        text.insert(at, 1, static_cast<char>(random.bits()));
        break;
    }
  }

  const std::vector<std::string>& seeds_;
};

struct Plan {
  uint64_t rounds = 1000;
  uint64_t from = 0;
  std::vector<std::string> files;
};

Plan plan_of(int count, char** arguments) {
  Plan plan;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--rounds" && i + 1 < count) {
      plan.rounds = std::strtoull(arguments[++i], nullptr, 10);
    } else if (word == "--from" && i + 1 < count) {
      plan.from = std::strtoull(arguments[++i], nullptr, 10);
    } else {
      plan.files.push_back(word);
    }
  }
  return plan;
}

}  // namespace

int main(int count, char** arguments) {
  const Plan plan = plan_of(count, arguments);
  const std::string name = arguments[0];
  crash_file = "crash-" + name.substr(name.rfind('/') + 1);
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit memory{kMostMemory, kMostMemory};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGALRM}) {
    ::signal(signal, leave_input);
  }
  for (const std::string& path : plan.files) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
      std::fprintf(stderr, "%s cannot be opened\n", path.c_str());
      return 1;
    }
    (void)try_one({std::istreambuf_iterator<char>(file), {}});
  }
  std::vector<std::string> seeds = hyades::fuzz::seeds();
  for (const std::string& seed : seeds) {
    if (seed.empty() || !try_one(seed)) {
      std::fprintf(stderr, "seed %td could not be made or is refused\n", &seed - seeds.data());
      return 1;
    }
  }
  std::erase_if(seeds, [](const std::string& seed) { return seed.size() > kMostSeedBytes; });
  if (seeds.empty()) {
    std::fprintf(stderr, "no seed is short enough to be changed\n");
    return 1;
  }
  const Changer changer(seeds);
  uint64_t taken = 0;
  for (uint64_t round = plan.from; round < plan.from + plan.rounds; ++round) {
    taken += try_one(changer.changed(round)) ? 1 : 0;
  }
  std::printf("%zu files, %zu seeds, %llu rounds of which %llu were taken\n", plan.files.size(),
              seeds.size(), static_cast<unsigned long long>(plan.rounds),
              static_cast<unsigned long long>(taken));
  return 0;
}
