#include "core/base/failpoint.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>

namespace hyades::core {
namespace {

struct Armed {
  std::string name;
  std::atomic<int> visits_left{0};

  Armed() {
    const char* text = std::getenv("HYADES_FAILPOINT");
    if (text == nullptr) return;
    name = text;
    visits_left = 1;
    if (const size_t colon = name.find(':'); colon != std::string::npos) {
      visits_left = std::atoi(name.c_str() + colon + 1);
      name.resize(colon);
    }
  }
};

}  // namespace

void failpoint(const char* name) {
  static Armed armed;
  if (armed.name.empty() || armed.name != name) return;
  if (--armed.visits_left == 0) ::kill(::getpid(), SIGKILL);
}

}  // namespace hyades::core
