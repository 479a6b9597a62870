#include "import/obj/mtl_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "import/obj/mtl_words.h"

namespace hyades::core {

namespace {

/// Numbers of an option, at most as many as `out` has; those that are missing stay as they are.
void take_numbers(std::string_view& rest, std::span<float> out) {
  for (float& number : out) {
    std::string_view after = rest;
    const std::string_view word = next_word(after);
    if (!is_number(word)) return;
    read_numbers(word, {&number, 1});
    rest = after;
  }
}

constexpr std::array<std::pair<std::string_view, const char*>, 5> kChannels = {{
    {"r", "red"},
    {"g", "green"},
    {"b", "blue"},
    {"m", "alpha"},
    {"l", "luminance"},
}};

/// An option with a word behind it that changes nothing, but for that one.
struct Neutral {
  std::string_view option;
  std::string_view word;
};

/// Corrected colours, the kind of a reflection, the size to which a small picture is blown up.
constexpr std::array<Neutral, 3> kNeutral = {{{"-cc", "off"}, {"-type", ""}, {"-texres", ""}}};

class MapLine {
 public:
  MapLine(MtlMap& map, std::vector<std::string>& left_out) : map_(map), left_out_(left_out) {}

  const char* read(std::string_view rest) {
    map_ = {};
    bool blend_u = true;
    bool blend_v = true;
    while (rest.starts_with('-')) {
      const std::string_view before = rest;
      option_ = next_word(rest);
      if (option_ == "-blendu") {
        blend_u = switched(rest);
      } else if (option_ == "-blendv") {
        blend_v = switched(rest);
      } else if (option_ == "-clamp") {
        map_.clamp = switched(rest);
      } else if (option_ == "-imfchan") {
        read_channel(rest);
      } else if (!read_numbers_of(rest)) {
        read_word(rest);
      }
      if (rest.data() == before.data()) break;
    }
    map_.blend = blend_u || blend_v;
    if (blend_u != blend_v) left_out_.emplace_back(blend_u ? "-blendv off" : "-blendu off");
    map_.file = std::string(rest);
    std::replace(map_.file.begin(), map_.file.end(), '\\', '/');
    return map_.file.empty() ? "expected a file name after its options" : nullptr;
  }

 private:
  void leave_out(std::string_view value) {
    left_out_.push_back(std::string(option_.substr(0, 20)) + " " +
                        std::string(value.substr(0, 40)));
  }

  bool switched(std::string_view& rest) {
    const std::string_view word = next_word(rest);
    if (word != "on" && word != "off") leave_out(word);
    return word == "on" || (word != "off" && option_ != "-clamp");
  }

  void read_channel(std::string_view& rest) {
    const std::string_view word = next_word(rest);
    const auto row = std::find_if(kChannels.begin(), kChannels.end(),
                                  [&](const auto& each) { return each.first == word; });
    if (row == kChannels.end()) {
      leave_out(word);
    } else {
      map_.channel = row->second;
    }
  }

  /// Whether it was an option of numbers.
  bool read_numbers_of(std::string_view& rest) {
    const std::string_view before = rest;
    const auto said = [&] {
      return trimmed(before.substr(0, static_cast<size_t>(rest.data() - before.data())));
    };
    float numbers[3] = {};
    if (option_ == "-o") {
      take_numbers(rest, numbers);
      map_.offset = {numbers[0], numbers[1]};
    } else if (option_ == "-s") {
      numbers[0] = 1.0F;
      numbers[1] = 1.0F;
      take_numbers(rest, numbers);
      map_.scale = {numbers[0], numbers[1]};
    } else if (option_ == "-mm") {
      numbers[1] = 1.0F;
      take_numbers(rest, {numbers, 2});
      map_.base = numbers[0];
      map_.gain = numbers[1];
    } else if (option_ == "-bm") {
      take_numbers(rest, {&map_.strength, 1});
    } else if (option_ == "-t" || option_ == "-boost") {
      // Turbulence; how much sharper than usual small pictures of it are.
      take_numbers(rest, {numbers, option_ == "-t" ? 3U : 1U});
      if (numbers[0] != 0.0F || numbers[1] != 0.0F || numbers[2] != 0.0F) leave_out(said());
    } else {
      return false;
    }
    return true;
  }

  void read_word(std::string_view& rest) {
    const std::string_view word = next_word(rest);
    for (const Neutral& each : kNeutral) {
      if (each.option == option_ && each.word == word) return;
    }
    leave_out(word);
  }

  MtlMap& map_;
  std::vector<std::string>& left_out_;
  std::string_view option_;
};

}  // namespace

const char* read_mtl_map(std::string_view rest, MtlMap& map, std::vector<std::string>& left_out) {
  return MapLine(map, left_out).read(rest);
}

}  // namespace hyades::core
