// What libFuzzer calls. With HYADES_FUZZ_SEEDS=FOLDER the program writes its seeds there and ends.

#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "tests/fuzz/fuzz.h"

namespace {

int write_seeds(const std::string& folder) {
  int number = 0;
  for (const std::string& seed : hyades::fuzz::seeds()) {
    std::ofstream file(folder + "/seed-" + std::to_string(number++), std::ios::binary);
    file.write(seed.data(), static_cast<std::streamsize>(seed.size()));
    if (!file.flush()) return 1;
  }
  return 0;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  if (const char* folder = std::getenv("HYADES_FUZZ_SEEDS")) std::exit(write_seeds(folder));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)hyades::fuzz::try_input({reinterpret_cast<const char*>(data), size});
  return 0;
}
