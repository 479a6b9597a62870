#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "coordinator/film_store/log_names.h"
#include "coordinator/film_store/segment.h"
#include "core/base/failpoint.h"

namespace hyades::coordinator {

using core::Error;
using core::Result;
using core::Status;

Status FilmLog::compact(uint64_t through, const std::function<Status(const Sink&)>& write,
                        const std::function<void()>& replaced) {
  const core::MutexLock one(compact_mutex_);
  {
    const core::MutexLock hold(mutex_);
    if (!replayed_) return Error{"the film log has to be replayed before it is compacted"};
    if (through > durable_) {
      return Error{
          fmt::format("record {} is not durable yet, so nothing can stand for it", through)};
    }
  }
  SegmentName name{0, true};
  {
    const core::MutexLock hold(files_mutex_);
    name.index = next_index_++;
  }
  const std::string file = path(segment_name(name));
  const std::string unfinished = file + kUnfinishedSuffix;
  // Appending goes on while the snapshot is written.
  if (Status s = write_snapshot(unfinished, name.index, through, write); !s) {
    [[maybe_unused]] const Status removed = files_.remove(unfinished);
    return s;
  }

  core::failpoint("snapshot-written");
  const core::MutexLock hold(files_mutex_);
  if (Status s = files_.rename(unfinished, file); !s) return s;
  if (Status s = files_.sync_folder(folder_); !s) return s;
  core::failpoint("snapshot-renamed");
  if (replaced) replaced();
  // The file being written ends here, so that it can go once its records are covered, too.
  active_.reset();
  const auto at = std::find_if(segments_.begin(), segments_.end(),
                               [&](const Segment& s) { return s.index > name.index; });
  segments_.insert(at, {segment_name(name), name.index, 0, true});
  return remove_segments([&](const Segment& s) {
    return s.snapshot ? s.index < name.index : s.last_sequence <= through;
  });
}

Status FilmLog::write_snapshot(const std::string& file, uint64_t index, uint64_t through,
                               const std::function<Status(const Sink&)>& write) {
  Result<std::unique_ptr<LogWriter>> writer = files_.create(file);
  if (!writer) return writer.error();
  const auto header = encode_segment_header({kSegmentVersion, true, index, through, salt_});
  if (Status s = (*writer)->write(header); !s) return s;
  uint64_t number = 0;
  uint64_t end = header.size();
  const Sink sink = [&](std::span<const std::byte> record) -> Status {
    if (record.empty() || record.size() > kMaxRecordBytes) {
      return Error{fmt::format("a record of {} bytes does not fit", record.size())};
    }
    place_ = {index, true, end};
    end += kRecordHeaderBytes + record.size();
    if (Status s = (*writer)->write(encode_record_header(record, ++number, salt_)); !s) return s;
    return (*writer)->write(record);
  };
  if (Status s = write(sink); !s) return s;
  return (*writer)->sync();
}

/// Removes files and forgets them; those that cannot be removed are removed after the next replay.
Status FilmLog::remove_segments(const std::function<bool(const Segment&)>& superseded) {
  Status result;
  bool removed_any = false;
  // Decided before anything moves, since the choice may look at places in the list.
  std::vector<Segment> kept;
  std::vector<Segment> gone;
  for (const Segment& segment : segments_) {
    (superseded(segment) ? gone : kept).push_back(segment);
  }
  for (const Segment& segment : gone) {
    if (Status s = files_.remove(path(segment.name)); !s) {
      result = s;
    } else {
      removed_any = true;
    }
  }
  segments_ = std::move(kept);
  if (removed_any) {
    if (Status s = files_.sync_folder(folder_); !s) result = s;
  }
  return result;
}

Status erase_film_log(const std::string& folder, LogFiles* files) {
  LogFiles& used = files != nullptr ? *files : disk_log_files();
  Result<std::vector<std::string>> names = used.list(folder);
  if (!names) return names.error();
  const auto lock = used.lock(folder + "/" + kLockName);
  if (!lock) return lock.error();
  // The guard goes last: a folder that is half erased still says whose it was.
  std::stable_partition(names->begin(), names->end(),
                        [](const std::string& name) { return name != kGuardName; });
  for (const std::string& name : *names) {
    if (!is_log_file(name) || name == kLockName) continue;
    if (Status s = used.remove(folder + "/" + name); !s) return s;
  }
  return used.sync_folder(folder);
}

}  // namespace hyades::coordinator
