// A segment of the film log, as a disk may give it back.

#include <cstring>

#include "coordinator/film_store/segment.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {
namespace {

constexpr uint64_t kSalt = 7;

class InputReader : public coordinator::LogReader {
 public:
  explicit InputReader(core::Bytes bytes) : bytes_(std::move(bytes)) {}
  uint64_t size() const override { return bytes_.size(); }
  core::Status read(uint64_t offset, std::span<std::byte> into) override {
    if (offset > size() || into.size() > size() - offset) return core::Error{"beyond the end"};
    std::memcpy(into.data(), bytes_.chars() + offset, into.size());
    return {};
  }

 private:
  core::Bytes bytes_;
};

template <class Range>
void append(std::string& text, const Range& bytes) {
  text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace

std::vector<std::string> seeds() {
  coordinator::SegmentHeader header;
  header.salt = kSalt;
  std::string segment;
  append(segment, coordinator::encode_segment_header(header));
  for (const std::string payload : {"first", "the second one", "3"}) {
    const auto bytes = std::as_bytes(std::span(payload));
    append(segment, coordinator::encode_record_header(bytes, 1 + segment.size(), kSalt));
    segment += payload;
  }
  return {segment};
}

bool try_input(std::string_view input) {
  const core::Bytes bytes = exact_bytes(input);
  if (bytes.size() < coordinator::kSegmentHeaderBytes) return false;
  const auto header =
      coordinator::decode_segment_header(bytes.span().first(coordinator::kSegmentHeaderBytes));
  InputReader reader(bytes);
  coordinator::SegmentScanner scanner(reader, kSalt);
  uint64_t payload = 0;
  while (scanner.next()) payload += scanner.payload().size();
  if (payload > bytes.size()) std::abort();
  return header.has_value() && payload > 0;
}

}  // namespace hyades::fuzz
