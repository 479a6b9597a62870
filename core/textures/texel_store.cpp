#include "core/textures/texel_store.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/machine.h"
#include "core/base/text.h"

namespace hyades::core {
namespace {

constexpr size_t kSmall = size_t{64} << 10U;  ///< bytes not worth a mapping of their own

std::string temporary_folder() {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  return error ? std::string("/tmp") : folder.string();
}

/// A descriptor that closes itself.
struct File {
  int descriptor = -1;
  ~File() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

/// 0, or what went wrong.
int write_all(int descriptor, const std::vector<std::byte>& bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written =
        ::pwrite(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    done += static_cast<size_t>(written);
  }
  return 0;
}

}  // namespace

TexelStore::TexelStore(uint64_t budget, std::string folder)
    : budget_(budget),
      folder_(folder.empty() ? temporary_folder() : std::move(folder)),
      used_(std::make_shared<std::atomic<uint64_t>>(0)) {}

uint64_t TexelStore::default_budget() {
  const uint64_t memory = usable_memory();
  return memory > 0 ? memory / 4 : UINT64_MAX;
}

Result<Bytes> TexelStore::keep(std::vector<std::byte> bytes) {
  const uint64_t size = bytes.size();
  // Counted before it is decided, so that two threads cannot both take the last room.
  const uint64_t before = used_->fetch_add(size);
  if (size > kSmall && (size > budget_ || before > budget_ - size)) {
    used_->fetch_sub(size);
    return keep_in_file(bytes);
  }
  bytes.shrink_to_fit();
  struct Counted {
    Counted(std::vector<std::byte> kept, std::shared_ptr<std::atomic<uint64_t>> counter)
        : bytes(std::move(kept)), used(std::move(counter)) {}
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    ~Counted() { used->fetch_sub(bytes.size()); }
    const std::vector<std::byte> bytes;
    const std::shared_ptr<std::atomic<uint64_t>> used;
  };
  auto owner = std::make_shared<Counted>(std::move(bytes), used_);
  const std::span<const std::byte> view(owner->bytes);
  return Bytes(std::move(owner), view);
}

Result<Bytes> TexelStore::keep_in_file(const std::vector<std::byte>& bytes) const {
  const auto failed = [&](int error) {
    return Error{
        fmt::format("{} of texels are more than is left of the memory for textures ({}), "
                    "and cannot be kept in {}: {}",
                    format_bytes(bytes.size()), format_bytes(budget_), folder_, io_reason(error))};
  };
  std::string name = folder_ + "/hyades-texels-XXXXXX";
  const File file{::mkostemp(name.data(), O_CLOEXEC)};
  if (file.descriptor < 0) return failed(errno);
  ::unlink(name.c_str());
  // All room is taken now: a page that found none later would be the end of the process.
  const int no_room = ::posix_fallocate(file.descriptor, 0, static_cast<off_t>(bytes.size()));
  if (no_room != 0) return failed(no_room);
  if (const int error = write_all(file.descriptor, bytes); error != 0) return failed(error);
  const size_t size = bytes.size();
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.descriptor, 0);
  if (address == MAP_FAILED) return failed(errno);
  // Neighbours in a file are neighbours in the picture, but not those of the next ray.
  ::madvise(address, size, MADV_RANDOM);
  std::shared_ptr<const void> owner(
      address, [size](const void* mapped) { ::munmap(const_cast<void*>(mapped), size); });
  return Bytes(std::move(owner), {static_cast<const std::byte*>(address), size});
}

}  // namespace hyades::core
