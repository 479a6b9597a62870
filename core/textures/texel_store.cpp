#include "core/textures/texel_store.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/machine.h"
#include "core/base/mutex.h"
#include "core/base/posix_file.h"
#include "core/base/text.h"

namespace hyades::core {
namespace {

constexpr size_t kSmall = size_t{64} << 10U;  ///< bytes not worth a mapping of their own

std::string temporary_folder() {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  return error ? std::string("/tmp") : folder.string();
}

}  // namespace

/// Parts of one file, each from a page of its own on.
class TexelStore::CommonFile {
 public:
  CommonFile(Descriptor file, uint64_t most) : file_(std::move(file)), most_(most) {}

  int descriptor() const { return file_.get(); }

  /// The first room that is large enough: the file gets no longer than it has to.
  Result<uint64_t> take(size_t size) {
    if (!file_.valid()) return Error{"it could not be made"};
    const uint64_t pages = whole_pages(size);
    const MutexLock lock(mutex_);
    if (taken_ + pages > half_of_free(file_) + taken_ / 2) {
      return Error{
          "it would take more than half of what is free on its disk (TMPDIR names another)"};
    }
    uint64_t begin = 0;
    for (const auto& [other, end] : parts_) {
      if (other - begin >= pages) break;
      begin = end;
    }
    if (begin + pages > most_) {
      return Error{
          fmt::format("it may take {}, of which {} are in use (--texture-disk of a worker)",
                      format_bytes(most_), format_bytes(taken_))};
    }
    parts_.emplace(begin, begin + pages);
    taken_ += pages;
    return begin;
  }
  void give_back(uint64_t begin) {
    const MutexLock lock(mutex_);
    const auto part = parts_.find(begin);
    const uint64_t size = part->second - begin;
    // Its room on the disk is free again, where the file system knows holes.
    ::fallocate(file_.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(begin),
                static_cast<off_t>(size));
    taken_ -= size;
    parts_.erase(part);
  }

 private:
  static uint64_t whole_pages(size_t size) {
    const auto page = static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
    return (size + page - 1) / page * page;
  }

  const Descriptor file_;
  const uint64_t most_;  ///< bytes, that the file's end may come to
  Mutex mutex_;
  /// Ends of what is in use, by begin.
  std::map<uint64_t, uint64_t> parts_ HYADES_GUARDED_BY(mutex_);
  uint64_t taken_ HYADES_GUARDED_BY(mutex_) = 0;  ///< bytes of these
};

/// Room for bytes in a file; what of it is in use has to be given back.
struct TexelStore::Place {
  std::shared_ptr<CommonFile> common;
  Descriptor own;  ///< where there is no common file
  uint64_t begin = 0;
  int descriptor() const { return common ? common->descriptor() : own.get(); }
};

TexelStore::TexelStore(uint64_t budget, Descriptor file, uint64_t most)
    : budget_(budget),
      folder_("the file for them"),
      common_(std::make_shared<CommonFile>(std::move(file), most)),
      used_(std::make_shared<std::atomic<uint64_t>>(0)) {}

TexelStore::TexelStore(uint64_t budget, std::string folder)
    : budget_(budget),
      folder_(folder.empty() ? temporary_folder() : std::move(folder)),
      used_(std::make_shared<std::atomic<uint64_t>>(0)) {}

uint64_t TexelStore::default_budget() {
  const uint64_t memory = usable_memory();
  return memory > 0 ? memory / 4 : UINT64_MAX;
}

uint64_t TexelStore::half_of_free(const Descriptor& file) {
  struct statvfs disk {};
  if (::fstatvfs(file.get(), &disk) != 0) return 0;
  return uint64_t{disk.f_bavail} * disk.f_frsize / 2;
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

Result<Descriptor> TexelStore::open_file(const std::string& folder) {
  std::string name = folder + "/hyades-texels-XXXXXX";
  Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
  if (!file.valid()) return Error{io_reason(errno)};
  ::unlink(name.c_str());
  return file;
}

Result<TexelStore::Place> TexelStore::place_for(size_t size) const {
  if (common_) {
    const auto begin = common_->take(size);
    if (!begin) return begin.error();
    return Place{common_, Descriptor(), *begin};
  }
  auto file = open_file(folder_);
  if (!file) return file.error();
  return Place{nullptr, std::move(*file), 0};
}

Result<Bytes> TexelStore::keep_in_file(const std::vector<std::byte>& bytes) const {
  const auto failed = [&](const std::string& why) {
    return Error{
        fmt::format("{} of texels are more than is left of the memory for textures ({}), "
                    "and cannot be kept in {}: {}",
                    format_bytes(bytes.size()), format_bytes(budget_), folder_, why)};
  };
  const size_t size = bytes.size();
  auto place = place_for(size);
  if (!place) return failed(place.error().message);
  // All room is taken now: a page that found none later would be the end of the process.
  const auto begin = static_cast<off_t>(place->begin);
  int error = ::posix_fallocate(place->descriptor(), begin, static_cast<off_t>(size));
  if (error == 0 && !write_all_at(place->descriptor(), bytes, place->begin)) error = errno;
  void* address = MAP_FAILED;
  if (error == 0) {
    address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, place->descriptor(), begin);
    if (address == MAP_FAILED) error = errno;
  }
  if (error != 0) {
    if (place->common) place->common->give_back(place->begin);
    return failed(io_reason(error));
  }
  // Neighbours in a file are neighbours in the picture, but not those of the next ray.
  ::madvise(address, size, MADV_RANDOM);
  std::shared_ptr<const void> owner(
      address, [size, common = place->common, begin = place->begin](const void* mapped) {
        ::munmap(const_cast<void*>(mapped), size);
        if (common) common->give_back(begin);
      });
  return Bytes(std::move(owner), {static_cast<const std::byte*>(address), size});
}

}  // namespace hyades::core
