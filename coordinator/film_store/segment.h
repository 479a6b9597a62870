#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "coordinator/film_store/log_files.h"
#include "core/base/result.h"

/// The bytes of the film log's segment files (docs/film-log.md). All numbers are little-endian.
namespace hyades::coordinator {

inline constexpr uint32_t kSegmentVersion = 1;
inline constexpr size_t kSegmentHeaderBytes = 48;
inline constexpr size_t kRecordHeaderBytes = 24;

/// The beginning of a segment.
struct SegmentHeader {
  uint32_t version = kSegmentVersion;
  bool snapshot = false;
  uint64_t index = 0;            ///< order of the segments
  uint64_t covered_through = 0;  ///< a snapshot stands for all records up to this number
  uint64_t salt = 0;             ///< of the log: records of other logs are not taken for its own
};

/// The bytes that a segment file begins with.
std::array<std::byte, kSegmentHeaderBytes> encode_segment_header(const SegmentHeader& header);

/// What a segment file's first bytes say; nothing where they are damaged or of another file.
std::optional<SegmentHeader> decode_segment_header(std::span<const std::byte> bytes);

/// What stands before a record's payload: magic, length, number, checksums of both.
std::array<std::byte, kRecordHeaderBytes> encode_record_header(std::span<const std::byte> payload,
                                                               uint64_t sequence, uint64_t salt);

/// What the header of a record says.
struct RecordHeader {
  uint32_t length = 0;  ///< of the payload, bytes
  uint64_t sequence = 0;
  uint32_t payload_crc = 0;
};

/// Reads the payload of the record that begins at `offset` of a segment. `damaged`: it is read, but
/// not what was written.
core::Status read_record(LogReader& reader, uint64_t offset, uint64_t salt,
                         std::vector<std::byte>& payload, bool& damaged);

/// Reads a segment's records one after the other, in memory bounded by the largest record, over
/// damaged and unreadable places.
class SegmentScanner {
 public:
  /// A place without whole records between, before or after those found.
  struct Gap {
    uint64_t begin = 0;
    uint64_t end = 0;
  };

  SegmentScanner(LogReader& reader, uint64_t salt) : reader_(reader), salt_(salt) {}

  /// Whether there is another whole record; then sequence() and payload() are its own.
  bool next();

  /// The number of the record that next() found.
  uint64_t sequence() const { return sequence_; }
  /// Where that record begins, with its header.
  uint64_t offset() const { return good_end_ - kRecordHeaderBytes - payload_.size(); }
  /// The bytes of that record; valid until next() is called again.
  std::span<const std::byte> payload() const { return payload_; }

  /// After next() returned false: where the last whole record ends (the segment header's end where
  /// there is none), and the gaps before that.
  uint64_t good_end() const { return good_end_; }
  const std::vector<Gap>& gaps() const { return gaps_; }

 private:
  void read(uint64_t offset, std::span<std::byte> into);
  std::optional<RecordHeader> header_at(uint64_t offset);
  std::optional<uint64_t> find_header(uint64_t from);

  LogReader& reader_;
  uint64_t salt_;
  uint64_t position_ = kSegmentHeaderBytes;
  uint64_t good_end_ = kSegmentHeaderBytes;
  uint64_t sequence_ = 0;
  std::vector<std::byte> payload_;
  std::vector<Gap> gaps_;
};

}  // namespace hyades::coordinator
