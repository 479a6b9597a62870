#include "coordinator/job_store/incarnation_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kBlock = 4096;  // what disks write as a whole, or more
constexpr size_t kBlocks = 2;
constexpr std::string_view kBegin = "hyades starts 1 ";  // 1: this format

core::Error failed(const std::string& path) { return {path + ": " + core::io_reason(errno)}; }

/// "hyades starts 1 NUMBER SHA-256\n" and zeros; the sum is of what stands before it.
std::string block_of(uint64_t starts) {
  std::string text = fmt::format("{}{} ", kBegin, starts);
  text += core::to_hex(core::sha256(text)) + "\n";
  text.resize(kBlock, '\0');
  return text;
}

/// What a block says; 0 where it is damaged, or was never written.
uint64_t starts_of(std::string_view block) {
  if (!block.starts_with(kBegin)) return 0;
  uint64_t starts = 0;
  const std::string_view digits = block.substr(kBegin.size());
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), starts);
  return read.ec == std::errc() && block == block_of(starts) ? starts : 0;
}

bool write_at(int file, std::string_view bytes, uint64_t offset) {
  return core::write_all_at(file, std::as_bytes(std::span(bytes)), offset);
}

bool sync_folder_of(const std::string& path) {
  return core::sync_folder(std::filesystem::path(path).parent_path().string());
}

}  // namespace

core::Result<uint64_t> count_start(const std::string& path, uint64_t known) {
  const core::Descriptor file = core::open_file(path, O_RDWR | O_CREAT, 0600);
  if (!file.valid()) return failed(path);
  std::string bytes(kBlock * kBlocks, '\0');
  const auto got = core::read_all_at(file.get(), std::as_writable_bytes(std::span(bytes)), 0);
  if (!got) return failed(path);
  const bool whole = *got == bytes.size();
  uint64_t last = known;
  for (size_t i = 0; i < kBlocks; ++i) {
    last = std::max(last, starts_of(std::string_view(bytes).substr(i * kBlock, kBlock)));
  }
  const uint64_t now = last + 1;
  const std::string block = block_of(now);
  if (!whole) {
    // Once: from now on it has all the room that it will ever need.
    bytes.replace(now % kBlocks * kBlock, kBlock, block);
    if (!write_at(file.get(), bytes, 0)) return failed(path);
  } else if (!write_at(file.get(), block, now % kBlocks * kBlock)) {
    return failed(path);
  }
  if (::fdatasync(file.get()) != 0 || (!whole && !sync_folder_of(path))) return failed(path);
  return now;
}

}  // namespace hyades::coordinator
