#include "coordinator/film_store/segment.h"

#include <algorithm>
#include <cstring>

#include "coordinator/film_store/film_log.h"
#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kSegmentMagic = 0x474F4C4D4C465948;  // "HYFLMLOG"
constexpr uint32_t kRecordMagic = 0x31524648;           // "HFR1"
constexpr size_t kSearchBytes = size_t{256} << 10U;

template <class T>
void put(std::span<std::byte> bytes, size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

template <class T>
T get(std::span<const std::byte> bytes, size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

uint32_t record_header_crc(std::span<const std::byte> header, uint64_t salt) {
  return core::crc32c(header.first(kRecordHeaderBytes - 4),
                      core::crc32c(std::as_bytes(std::span(&salt, 1))));
}

}  // namespace

std::array<std::byte, kSegmentHeaderBytes> encode_segment_header(const SegmentHeader& header) {
  std::array<std::byte, kSegmentHeaderBytes> bytes{};
  put(bytes, 0, kSegmentMagic);
  put(bytes, 8, header.version);
  put(bytes, 12, uint32_t{header.snapshot ? 1U : 0U});
  put(bytes, 16, header.index);
  put(bytes, 24, header.covered_through);
  put(bytes, 32, header.salt);
  put(bytes, 44, core::crc32c(std::span(bytes).first(44)));
  return bytes;
}

std::optional<SegmentHeader> decode_segment_header(std::span<const std::byte> bytes) {
  if (bytes.size() < kSegmentHeaderBytes || get<uint64_t>(bytes, 0) != kSegmentMagic ||
      get<uint32_t>(bytes, 44) != core::crc32c(bytes.first(44))) {
    return std::nullopt;
  }
  return SegmentHeader{get<uint32_t>(bytes, 8), get<uint32_t>(bytes, 12) != 0,
                       get<uint64_t>(bytes, 16), get<uint64_t>(bytes, 24),
                       get<uint64_t>(bytes, 32)};
}

std::array<std::byte, kRecordHeaderBytes> encode_record_header(std::span<const std::byte> payload,
                                                               uint64_t sequence, uint64_t salt) {
  std::array<std::byte, kRecordHeaderBytes> bytes{};
  put(bytes, 0, kRecordMagic);
  put(bytes, 4, static_cast<uint32_t>(payload.size()));
  put(bytes, 8, sequence);
  put(bytes, 16, core::crc32c(payload));
  put(bytes, 20, record_header_crc(bytes, salt));
  return bytes;
}

namespace {

/// Nothing where the bytes are no header, or of a record that does not end within `left` bytes.
std::optional<RecordHeader> decode_record_header(
    const std::array<std::byte, kRecordHeaderBytes>& bytes, uint64_t salt, uint64_t left) {
  const RecordHeader header{get<uint32_t>(bytes, 4), get<uint64_t>(bytes, 8),
                            get<uint32_t>(bytes, 16)};
  const bool whole = get<uint32_t>(bytes, 0) == kRecordMagic &&
                     get<uint32_t>(bytes, 20) == record_header_crc(bytes, salt) &&
                     header.length <= FilmLog::kMaxRecordBytes && header.length <= left;
  return whole ? std::optional(header) : std::nullopt;
}

}  // namespace

core::Status read_record(LogReader& reader, uint64_t offset, uint64_t salt,
                         std::vector<std::byte>& payload, bool& damaged) {
  damaged = false;
  std::array<std::byte, kRecordHeaderBytes> header{};
  if (core::Status read = reader.read(offset, header); !read) return read;
  const uint64_t begin = offset + kRecordHeaderBytes;
  const auto told = decode_record_header(header, salt, reader.size() - begin);
  damaged = !told;
  if (damaged) return core::Error{"the header of a record is damaged"};
  payload.resize(told->length);
  if (core::Status read = reader.read(begin, payload); !read) return read;
  damaged = core::crc32c(payload) != told->payload_crc;
  if (damaged) return core::Error{"a record is damaged"};
  return {};
}

/// What cannot be read counts as zeros, which no checksum accepts.
void SegmentScanner::read(uint64_t offset, std::span<std::byte> into) {
  if (!reader_.read(offset, into).ok()) std::fill(into.begin(), into.end(), std::byte{0});
}

std::optional<RecordHeader> SegmentScanner::header_at(uint64_t offset) {
  if (offset + kRecordHeaderBytes > reader_.size()) return std::nullopt;
  std::array<std::byte, kRecordHeaderBytes> bytes{};
  read(offset, bytes);
  return decode_record_header(bytes, salt_, reader_.size() - offset - kRecordHeaderBytes);
}

/// The next place from `from` on at which a record header stands whole.
std::optional<uint64_t> SegmentScanner::find_header(uint64_t from) {
  std::vector<std::byte> window;
  while (from + kRecordHeaderBytes <= reader_.size()) {
    window.resize(static_cast<size_t>(std::min<uint64_t>(kSearchBytes, reader_.size() - from)));
    read(from, window);
    for (size_t i = 0; i + sizeof kRecordMagic <= window.size(); ++i) {
      if (get<uint32_t>(window, i) == kRecordMagic && header_at(from + i)) return from + i;
    }
    if (from + window.size() >= reader_.size()) break;
    from += window.size() - (sizeof kRecordMagic - 1);
  }
  return std::nullopt;
}

bool SegmentScanner::next() {
  while (true) {
    std::optional<RecordHeader> header = header_at(position_);
    if (!header) {
      const std::optional<uint64_t> found = find_header(position_ + 1);
      if (!found) return false;
      position_ = *found;
      header = header_at(position_);
      if (!header) continue;  // read once and then no more: a dying disk
    }
    const uint64_t begin = position_;
    payload_.resize(header->length);
    read(begin + kRecordHeaderBytes, payload_);
    // The header's own checksum holds, so its length can be trusted either way.
    position_ = begin + kRecordHeaderBytes + header->length;
    if (core::crc32c(payload_) != header->payload_crc) continue;
    if (begin > good_end_) gaps_.push_back({good_end_, begin});
    good_end_ = position_;
    sequence_ = header->sequence;
    return true;
  }
}

}  // namespace hyades::coordinator
