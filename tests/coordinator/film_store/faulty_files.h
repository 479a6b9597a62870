#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/film_store/log_files.h"

namespace hyades::coordinator {

/// Files in memory that fail, tear and forget as real ones may: bytes that were not synced and
/// names that were not synced can be lost, in any combination, by crash().
class FaultyFiles final : public LogFiles {
 public:
  struct File {
    std::vector<std::byte> bytes;
    std::vector<std::byte> durable;
    bool lost = false;  ///< a sync failed: the kernel takes its pages for clean from now on
  };
  using Names = std::map<std::string, std::shared_ptr<File>>;

  /// From the n-th operation that changes anything on, all fail: the power is gone.
  void fail_from_operation(uint64_t n) { fail_from_ = n; }
  /// The next sync fails, and what it should have stored is not stored by later ones either.
  void fail_next_sync() { fail_sync_ = true; }
  /// The next write stores only this many bytes, then fails.
  void fail_next_write_after(size_t bytes) { write_budget_ = bytes; }
  /// The next truncation fails.
  void fail_next_truncate() { fail_truncate_ = true; }
  /// No file can be opened to be read, as when the process has too many.
  void refuse_to_open(bool refuse) { refuse_to_open_ = refuse; }
  /// What stands from here on cannot be read for now.
  void refuse_to_read_from(uint64_t offset) { readable_ = offset; }
  /// All files together may hold this many bytes.
  void set_capacity(uint64_t bytes) { capacity_ = bytes; }

  uint64_t operations() const { return operations_; }
  uint64_t syncs() const { return syncs_; }

  /// The process was killed, the machine goes on: nothing that was written is lost.
  void kill() {
    const std::lock_guard<std::mutex> hold(mutex_);
    locks_.clear();
    fail_from_ = UINT64_MAX;
  }

  /// The power fails: every name and every byte that was not synced is kept or lost by chance; torn
  /// tails may hold zeros. Locks are gone.
  void crash(std::mt19937& random) {
    const std::lock_guard<std::mutex> hold(mutex_);
    Names after;
    std::set<std::string> all;
    for (const auto& [name, file] : names_) all.insert(name);
    for (const auto& [name, file] : durable_names_) all.insert(name);
    for (const std::string& name : all) {
      const Names& from = random() % 2 == 0 ? names_ : durable_names_;
      const auto found = from.find(name);
      if (found != from.end()) after[name] = found->second;
    }
    for (auto& [name, file] : after) {
      std::vector<std::byte> kept = file->durable;
      if (file->bytes.size() > kept.size()) {
        const size_t unsynced = file->bytes.size() - kept.size();
        const size_t length = random() % (unsynced + 1);
        const size_t zeros_from = random() % 3 == 0 ? random() % (length + 1) : length;
        for (size_t i = 0; i < length; ++i) {
          kept.push_back(i < zeros_from ? file->bytes[file->durable.size() + i] : std::byte{0});
        }
      }
      file = std::make_shared<File>(File{kept, kept, false});
    }
    names_ = durable_names_ = after;
    locks_.clear();
    fail_from_ = UINT64_MAX;
    fail_sync_ = false;
    write_budget_ = SIZE_MAX;
  }

  /// The current content, to damage it.
  std::vector<std::byte>& bytes(const std::string& path) {
    const std::lock_guard<std::mutex> hold(mutex_);
    return names_.at(path)->bytes;
  }
  std::vector<std::string> paths() const {
    std::vector<std::string> result;
    for (const auto& [name, file] : names_) result.push_back(name);
    return result;
  }

  core::Status make_folder(const std::string&) override { return {}; }

  core::Status sync_folder(const std::string&) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s;
    durable_names_ = names_;
    return {};
  }

  core::Result<std::vector<std::string>> list(const std::string& folder) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    std::vector<std::string> result;
    for (const auto& [name, file] : names_) result.push_back(name.substr(folder.size() + 1));
    return result;
  }

  core::Result<std::unique_ptr<LogWriter>> create(const std::string& path) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s.error();
    if (names_.count(path) != 0) return core::Error{path + " exists"};
    const auto file = std::make_shared<File>();
    names_[path] = file;
    return std::unique_ptr<LogWriter>(std::make_unique<Writer>(*this, file));
  }

  core::Result<std::unique_ptr<LogReader>> open(const std::string& path) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    const auto found = names_.find(path);
    if (found == names_.end()) return core::Error{path + " does not exist"};
    if (refuse_to_open_) return core::Error{path + ": too many open files"};
    return std::unique_ptr<LogReader>(
        std::make_unique<Reader>(found->second->bytes, readable_.load()));
  }

  core::Status sync_file(const std::string& path) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s;
    File& file = *names_.at(path);
    if (!file.lost) file.durable = file.bytes;
    return {};
  }

  core::Status rename(const std::string& from, const std::string& to) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s;
    const auto found = names_.find(from);
    if (found == names_.end()) return core::Error{from + " does not exist"};
    names_[to] = found->second;
    names_.erase(from);
    return {};
  }

  core::Status remove(const std::string& path) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s;
    return names_.erase(path) == 1 ? core::Status() : core::Error{path + " does not exist"};
  }

  core::Status truncate(const std::string& path, uint64_t size) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (core::Status s = operate(); !s) return s;
    if (std::exchange(fail_truncate_, false)) return core::Error{"input/output error"};
    File& file = *names_.at(path);
    file.bytes.resize(std::min<size_t>(file.bytes.size(), size));
    file.durable.resize(std::min<size_t>(file.durable.size(), size));
    return {};
  }

  core::Result<std::unique_ptr<LogLock>> lock(const std::string& path) override {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (!locks_.insert(path).second) return core::Error{path + " is held"};
    return std::unique_ptr<LogLock>(std::make_unique<Lock>(*this, path));
  }

 private:
  class Writer final : public LogWriter {
   public:
    Writer(FaultyFiles& files, std::shared_ptr<File> file)
        : files_(files), file_(std::move(file)) {}

    core::Status write(std::span<const std::byte> bytes) override {
      const std::lock_guard<std::mutex> hold(files_.mutex_);
      if (core::Status s = files_.operate(); !s) {
        // The power goes while it writes: some of it may have reached the disk.
        if (!std::exchange(dead_, true)) take(bytes, bytes.size() / 2);
        return s;
      }
      uint64_t used = 0;
      for (const auto& [name, file] : files_.names_) used += file->bytes.size();
      const size_t room = static_cast<size_t>(
          std::min<uint64_t>(files_.capacity_ - std::min(used, files_.capacity_), SIZE_MAX));
      const size_t budget = std::min(std::exchange(files_.write_budget_, SIZE_MAX), room);
      take(bytes, std::min(budget, bytes.size()));
      return budget < bytes.size() ? core::Status(core::Error{"no space left"}) : core::Status();
    }

    core::Status sync() override {
      const std::lock_guard<std::mutex> hold(files_.mutex_);
      if (core::Status s = files_.operate(); !s) return s;
      if (std::exchange(files_.fail_sync_, false)) {
        file_->lost = true;  // later syncs say yes
        return core::Error{"input/output error"};
      }
      ++files_.syncs_;
      if (!file_->lost) file_->durable = file_->bytes;
      return {};
    }

   private:
    void take(std::span<const std::byte> bytes, size_t count) {
      file_->bytes.insert(file_->bytes.end(), bytes.begin(),
                          bytes.begin() + static_cast<ptrdiff_t>(count));
    }
    FaultyFiles& files_;
    std::shared_ptr<File> file_;
    bool dead_ = false;
  };

  class Reader final : public LogReader {
   public:
    Reader(std::vector<std::byte> bytes, uint64_t readable)
        : bytes_(std::move(bytes)), readable_(readable) {}
    std::string passing_trouble() const override { return trouble_; }
    uint64_t size() const override { return bytes_.size(); }
    core::Status read(uint64_t offset, std::span<std::byte> into) override {
      if (offset > bytes_.size() || into.size() > bytes_.size() - offset) {
        return core::Error{"it ends too early"};
      }
      if (offset + into.size() > readable_) {
        trouble_ = "it cannot be read now";
        return core::Error{trouble_};
      }
      if (!into.empty()) std::memcpy(into.data(), bytes_.data() + offset, into.size());
      return {};
    }

   private:
    std::vector<std::byte> bytes_;
    uint64_t readable_;
    std::string trouble_;
  };

  class Lock final : public LogLock {
   public:
    Lock(FaultyFiles& files, std::string path) : files_(files), path_(std::move(path)) {}
    ~Lock() override {
      const std::lock_guard<std::mutex> hold(files_.mutex_);
      files_.locks_.erase(path_);
    }

   private:
    FaultyFiles& files_;
    std::string path_;
  };

  core::Status operate() {
    return ++operations_ > fail_from_ ? core::Status(core::Error{"the power is gone"})
                                      : core::Status();
  }

  std::mutex mutex_;
  Names names_;
  Names durable_names_;
  std::set<std::string> locks_;
  uint64_t operations_ = 0;
  uint64_t syncs_ = 0;
  uint64_t fail_from_ = UINT64_MAX;
  uint64_t capacity_ = UINT64_MAX;
  size_t write_budget_ = SIZE_MAX;
  std::atomic<bool> refuse_to_open_{false};
  std::atomic<uint64_t> readable_{UINT64_MAX};
  bool fail_sync_ = false;
  bool fail_truncate_ = false;
};

}  // namespace hyades::coordinator
