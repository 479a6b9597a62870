#include "cli/display/packets.h"

#include <bit>
#include <cstring>
#include <utility>

namespace hyades::cli {
namespace {

enum class Operation : uint8_t { close = 2, create = 4, update = 6 };

/// A packet that grows field by field.
class Packet {
 public:
  explicit Packet(Operation operation) : bytes_(4, '\0') { bytes_ += static_cast<char>(operation); }

  void add(bool value) { bytes_ += value ? '\1' : '\0'; }
  void add(int32_t value) { add_bytes(static_cast<uint32_t>(value), 4); }
  void add(int64_t value) { add_bytes(static_cast<uint64_t>(value), 8); }
  void add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) add(text);
  }
  void add(std::span<const float> values) {
    if constexpr (std::endian::native == std::endian::little) {
      const size_t begin = bytes_.size();
      bytes_.resize(begin + values.size_bytes());
      if (!values.empty()) std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
    } else {
      for (const float value : values) add_bytes(std::bit_cast<uint32_t>(value), 4);
    }
  }

  std::string take() {
    for (size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  void add_bytes(uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_ += static_cast<char>(value >> (8 * i));
  }

  std::string bytes_;
};

}  // namespace

std::string create_picture(const std::string& name, bool focus, int width, int height,
                           const std::vector<std::string>& channels) {
  Packet packet(Operation::create);
  packet.add(focus);
  packet.add(name);
  packet.add(int32_t{width});
  packet.add(int32_t{height});
  packet.add(static_cast<int32_t>(channels.size()));
  packet.add(channels);
  return packet.take();
}

std::string update_picture(const std::string& name, const core::PixelRect& part,
                           const std::vector<std::string>& channels,
                           std::span<const float> values) {
  const auto count = static_cast<int64_t>(channels.size());
  Packet packet(Operation::update);
  packet.add(false);
  packet.add(name);
  packet.add(static_cast<int32_t>(count));
  packet.add(channels);
  for (const int32_t edge : {part.x0, part.y0, part.width(), part.height()}) packet.add(edge);
  for (int64_t c = 0; c < count; ++c) packet.add(c);      // where the channel begins
  for (int64_t c = 0; c < count; ++c) packet.add(count);  // from one pixel of it to the next
  packet.add(values);
  return packet.take();
}

std::string close_picture(const std::string& name) {
  Packet packet(Operation::close);
  packet.add(name);
  return packet.take();
}

}  // namespace hyades::cli
