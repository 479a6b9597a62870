#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "coordinator/film_store/log_names.h"
#include "coordinator/film_store/segment.h"

namespace hyades::coordinator {
namespace {

using core::Error;
using core::Result;
using core::Status;

constexpr size_t kMaxProblems = 100;

void note(ReplayReport& report, std::string problem) {
  if (report.problems.size() < kMaxProblems) report.problems.push_back(std::move(problem));
}

}  // namespace

/// What of the folder has been found so far.
struct FilmLog::Replay {
  const Visitor& visitor;
  ReplayReport report;
  std::optional<size_t> newest;  ///< place of the newest snapshot among the segments
  uint64_t covered = 0;          ///< records up to this number stand in the snapshot
  uint64_t last_sequence = 0;
  std::unordered_set<uint64_t> seen;  ///< a group whose sync failed was written twice
  std::string trouble{};              ///< LogReader::passing_trouble() of some segment
};

Result<ReplayReport> FilmLog::replay(const Visitor& visitor) {
  const core::MutexLock hold(files_mutex_);
  {
    const core::MutexLock hold_state(mutex_);
    if (replayed_) return Error{"the film log was replayed already"};
  }
  const Result<std::vector<Segment>> found = find_segments();
  if (!found) return found.error();
  Replay state{visitor, {}, {}, 0, 0, {}};
  if (Status s = find_newest_snapshot(*found, state); !s) return s.error();
  std::vector<Segment> segments = replay_segments(*found, state);
  if (!state.trouble.empty()) return Error{state.trouble};
  segments_ = std::move(segments);
  next_index_ = found->empty() ? 1 : found->back().index + 1;
  // After kill -9 some of what was read may still be on its way to the disk, and a
  // snapshot's name too, before what it replaces is removed.
  for (const Segment& segment : segments_) {
    if (Status s = files_.sync_file(path(segment.name)); !s) return s.error();
  }
  if (Status s = files_.sync_folder(folder_); !s) return s.error();
  // A compaction may have been interrupted before it removed what it replaced.
  if (state.newest) {
    const uint64_t index = (*found)[*state.newest].index;
    const Status removed = remove_segments([&](const Segment& s) {
      return s.snapshot ? s.index < index : s.last_sequence <= state.covered;
    });
    if (!removed) note(state.report, removed.error().message);
  }

  const core::MutexLock hold_numbers(mutex_);
  next_sequence_ = state.last_sequence + 1;
  durable_ = state.last_sequence;
  replayed_ = true;
  return std::move(state.report);
}

/// The folder's files in the order of their indices; what a crash has left unfinished goes.
Result<std::vector<FilmLog::Segment>> FilmLog::find_segments() {
  Result<std::vector<std::string>> names = files_.list(folder_);
  if (!names) return names.error();
  std::vector<Segment> found;
  for (const std::string& name : *names) {
    if (const std::optional<SegmentName> parsed = parse_segment_name(name)) {
      found.push_back({name, parsed->index, 0, parsed->snapshot});
    } else if (is_log_file(name) && name.ends_with(kUnfinishedSuffix)) {
      [[maybe_unused]] const Status removed = files_.remove(path(name));  // tried again next time
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Segment& a, const Segment& b) { return a.index < b.index; });
  return found;
}

/// The newest snapshot stands for everything before it, older snapshots included.
Status FilmLog::find_newest_snapshot(const std::vector<Segment>& found, Replay& state) {
  for (size_t i = 0; i < found.size(); ++i) {
    const Result<std::optional<SegmentHeader>> header = read_header(found[i]);
    if (!header) return header.error();
    if (found[i].snapshot && *header) {
      state.newest = i;
      state.covered = (*header)->covered_through;
    }
  }
  state.last_sequence = state.covered;
  return {};
}

/// Replays the newest snapshot, then the segments in their order, and returns all of them.
std::vector<FilmLog::Segment> FilmLog::replay_segments(const std::vector<Segment>& found,
                                                       Replay& state) {
  std::vector<Segment> kept;
  std::vector<size_t> damaged;
  const auto keep = [&](Segment segment, bool last) {
    if (!replay_segment(segment, last, state)) damaged.push_back(kept.size());
    kept.push_back(std::move(segment));
  };
  if (state.newest) keep(found[*state.newest], false);
  for (size_t i = 0; i < found.size(); ++i) {
    if (i == state.newest) continue;
    if (state.newest && found[i].snapshot && i < *state.newest) {
      kept.push_back(found[i]);
    } else {
      keep(found[i], i + 1 == found.size());
    }
  }
  // What cannot be read now may yet be read after a repair: it goes only with a snapshot that
  // stands for all that has been appended by now.
  for (const size_t i : damaged) kept[i].last_sequence = state.last_sequence;
  return kept;
}

/// The segment's header, nothing where it is damaged; an error for newer versions.
Result<std::optional<SegmentHeader>> FilmLog::read_header(const Segment& segment) {
  Result<std::unique_ptr<LogReader>> reader = files_.open(path(segment.name));
  if (!reader) return reader.error();
  std::array<std::byte, kSegmentHeaderBytes> bytes{};
  std::optional<SegmentHeader> header;
  if ((*reader)->size() >= bytes.size() && (*reader)->read(0, bytes)) {
    header = decode_segment_header(bytes);
  }
  if (const std::string trouble = (*reader)->passing_trouble(); !trouble.empty()) {
    return Error{trouble};
  }
  if (header && header->version > kSegmentVersion) {
    return Error{fmt::format("{} was written by a newer version of Hyades (format {}, known: {})",
                             path(segment.name), header->version, kSegmentVersion)};
  }
  if (header && (header->salt != salt_ || header->index != segment.index ||
                 header->snapshot != segment.snapshot)) {
    header.reset();  // of another log, or renamed
  }
  return header;
}

/// Returns whether all of it could be read.
bool FilmLog::replay_segment(Segment& segment, bool last, Replay& state) {
  const std::string file = path(segment.name);
  Result<std::unique_ptr<LogReader>> reader = files_.open(file);
  if (!reader) {
    note(state.report, reader.error().message);
    return false;
  }

  SegmentScanner scanner(**reader, salt_);
  while (scanner.next()) {
    if (!segment.snapshot) {
      segment.last_sequence = std::max(segment.last_sequence, scanner.sequence());
      state.last_sequence = std::max(state.last_sequence, scanner.sequence());
      if (scanner.sequence() <= state.covered || !state.seen.insert(scanner.sequence()).second) {
        continue;
      }
    }
    place_ = {segment.index, segment.snapshot, scanner.offset()};
    if (const Status taken = state.visitor(scanner.payload()); !taken) {
      note(state.report, fmt::format("{}: record {} was refused: {}", file, scanner.sequence(),
                                     taken.error().message));
      continue;
    }
    ++state.report.records;
    state.report.bytes += scanner.payload().size();
  }

  // Nothing is cut off or taken for lost that is only not to be had now.
  if (std::string trouble = (*reader)->passing_trouble(); !trouble.empty()) {
    state.trouble = std::move(trouble);
    return false;
  }
  for (const SegmentScanner::Gap& gap : scanner.gaps()) {
    state.report.damaged_bytes += gap.end - gap.begin;
    note(state.report, fmt::format("{}: bytes {} to {} are damaged; what they held has to be "
                                   "rendered again",
                                   file, gap.begin, gap.end - 1));
  }
  const uint64_t size = (*reader)->size();
  if (size <= scanner.good_end()) return scanner.gaps().empty();
  const uint64_t tail = size - scanner.good_end();
  if (!last || segment.snapshot) {
    state.report.damaged_bytes += tail;
    note(state.report, fmt::format("{}: the last {} bytes are damaged", file, tail));
    return false;
  }
  // The end of the last file: a crash interrupted writing it.
  state.report.torn_bytes += tail;
  reader->reset();
  if (const Status cut = files_.truncate(file, scanner.good_end()); !cut) {
    note(state.report, cut.error().message);
  }
  return scanner.gaps().empty();
}

}  // namespace hyades::coordinator
