#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/image/decoders.h"

/// What a lamp's maker measures: candela by direction (ANSI/IES LM-63, "Approved Method: IES
/// Standard File Format for the Electronic Transfer of Photometric Data"), as a lat-long picture.
namespace hyades::core {
namespace {

/// Half a degree each.
constexpr int kWidth = 720;
constexpr int kHeight = 360;
/// Of a watt of white light (illuminant D65), as Cycles takes it [lm/W].
constexpr double kLumensPerWatt = 177.83;
constexpr size_t kMostAngles = 10'000;

/// The numbers of the file, one after the other; between them stand spaces, commas or ends of
/// lines.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : text_(text) {}

  /// The next one; nothing where something else stands there, or nothing.
  std::optional<double> next() {
    const size_t begin = text_.find_first_not_of(", \t\r\n");
    if (begin == std::string_view::npos) return std::nullopt;
    text_.remove_prefix(begin);
    if (text_.front() == '+') text_.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text_.remove_prefix(static_cast<size_t>(end - text_.data()));
    return value;
  }

  /// The next `count` ones.
  std::optional<std::vector<double>> next(size_t count) {
    std::vector<double> all;
    for (size_t i = 0; i < count; ++i) {
      const auto one = next();
      if (!one) return std::nullopt;
      all.push_back(*one);
    }
    return all;
  }

  std::string_view left() const { return text_; }

 private:
  std::string_view text_;
};

/// Candela by angles in degrees, of photometric type C: vertical from straight down (0) to straight
/// up (180), horizontal around that, counter-clockwise seen from above.
struct Photometry {
  std::vector<double> vertical;
  std::vector<double> horizontal;
  std::vector<double> candela;  ///< of each horizontal angle all vertical ones

  double at(size_t h, double up) const {
    if (up < vertical.front() || up > vertical.back()) return 0.0;
    const double* const row = candela.data() + h * vertical.size();
    return between(vertical, up, [&](size_t v) { return row[v]; });
  }
  double at(double around, double up) const {
    return between(horizontal, folded(around), [&](size_t h) { return at(h, up); });
  }

 private:
  /// The angle that stands for `around` where the lamp is the same on several sides.
  double folded(double around) const {
    const double first = horizontal.front();
    const double last = horizontal.back();
    if (last == 90.0 && first == 0.0) around = std::fmod(around, 180.0);
    if (last == 90.0 && first == 0.0 && around > 90.0) return 180.0 - around;
    if (last == 180.0 && first == 0.0 && around > 180.0) return 360.0 - around;
    if (first == 90.0 && (around < 90.0 || around > 270.0)) return std::fmod(540.0 - around, 360.0);
    return around;
  }

  /// Linear between the two of `angles` that stand around `x`; beyond them as at the last.
  template <class Value>
  static double between(const std::vector<double>& angles, double x, const Value& value) {
    const auto above = std::upper_bound(angles.begin(), angles.end(), x);
    if (above == angles.begin()) return value(0);
    const auto i = static_cast<size_t>(above - angles.begin());
    if (i == angles.size()) return value(i - 1);
    const double share = (x - angles[i - 1]) / (angles[i] - angles[i - 1]);
    return (1.0 - share) * value(i - 1) + share * value(i);
  }
};

/// What stands behind the line TILT=, which ends the part of the file that people read.
Result<std::string_view> numbers_of(std::string_view text) {
  const size_t tilt = text.find("TILT=");
  if (tilt == std::string_view::npos) return Error{"there is no line TILT="};
  text.remove_prefix(tilt + 5);
  const std::string_view how = text.substr(0, text.find_first_of(" \t\r\n"));
  if (how != "NONE" && how != "INCLUDE") {
    return Error{fmt::format("TILT={} is not read, expected NONE or INCLUDE", how.substr(0, 40))};
  }
  text.remove_prefix(how.size());
  if (how == "NONE") return text;
  // How the lamp dims where the luminaire is tilted, which ours never is: as if level.
  Numbers numbers(text);
  const auto head = numbers.next(2);
  if (!head || !((*head)[1] >= 0 && (*head)[1] <= kMostAngles)) {
    return Error{"expected the number of tilt angles after TILT=INCLUDE"};
  }
  if (!numbers.next(2 * static_cast<size_t>((*head)[1]))) {
    return Error{"the angles of TILT=INCLUDE are not complete"};
  }
  return numbers.left();
}

bool are_ascending(const std::vector<double>& angles) {
  return std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) == angles.end();
}

Status check_angles(const Photometry& lamp) {
  const std::vector<double>& v = lamp.vertical;
  const std::vector<double>& h = lamp.horizontal;
  if (!are_ascending(v) || v.front() < 0.0 || v.back() > 180.0) {
    return Error{"expected vertical angles that grow from 0 to 180 degrees"};
  }
  const bool whole =
      h.size() == 1 ||
      (h.front() == 0.0 && (h.back() == 90.0 || h.back() == 180.0 || h.back() == 360.0)) ||
      (h.front() == 90.0 && h.back() == 270.0);
  if (!are_ascending(h) || !whole) {
    return Error{
        "expected horizontal angles that grow from 0 to 90, 180 or 360, or from 90 to 270 degrees"};
  }
  return {};
}

Result<Photometry> read_photometry(std::string_view text) {
  const auto found = numbers_of(text);
  if (!found) return found.error();
  Numbers numbers(*found);
  const auto head = numbers.next(13);
  if (!head) return Error{"expected 13 numbers after TILT"};
  const std::vector<double>& n = *head;
  const auto is_count = [](double x) {
    return x >= 1.0 && x <= static_cast<double>(kMostAngles) && x == std::floor(x);
  };
  if (!is_count(n[3]) || !is_count(n[4]) || n[3] * n[4] > 1e6) {
    return Error{fmt::format("{} x {} angles; expected 1 to {} each, and a million in all", n[3],
                             n[4], kMostAngles)};
  }
  if (n[5] != 1.0) {
    return Error{fmt::format("photometry of type {}, expected type 1 (C)", n[5])};
  }
  Photometry lamp;
  auto vertical = numbers.next(static_cast<size_t>(n[3]));
  auto horizontal = vertical ? numbers.next(static_cast<size_t>(n[4])) : std::nullopt;
  auto candela = horizontal ? numbers.next(vertical->size() * horizontal->size()) : std::nullopt;
  if (!candela) return Error{"the file is truncated, or something in it is no number"};
  // Multiplier, ballast factor, and what the standard calls ballast-lamp photometric factor.
  const double factor = n[2] * n[10] * n[11];
  if (!std::isfinite(factor * 1e9)) return Error{"its multipliers are too large"};
  for (double& one : *candela) one = std::max(one * factor, 0.0);
  lamp = {std::move(*vertical), std::move(*horizontal), std::move(*candela)};
  if (Status s = check_angles(lamp); !s) return s.error();
  return lamp;
}

}  // namespace

Result<Image> decode_ies(std::span<const std::byte> file, bool /*srgb*/,
                         const ImageLimits& limits) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const auto lamp = read_photometry(text);
  if (!lamp) return lamp.error();
  if (Status s = check_image_size(kWidth, kHeight, 1, limits); !s) return s.error();
  Image image = make_image(kWidth, kHeight, {"Y"});
  constexpr double kShare = 4.0 * 3.14159265358979323846 / kLumensPerWatt;
  for (int y = 0; y < kHeight; ++y) {
    const double up = 180.0 - (y + 0.5) * (180.0 / kHeight);
    for (int x = 0; x < kWidth; ++x) {
      // Columns go from -x by -z, x and z around: clockwise seen from above.
      const double around = std::fmod(540.0 - (x + 0.5) * (360.0 / kWidth), 360.0);
      const double value = kShare * lamp->at(around, up);
      image.at(x, y, 0) = static_cast<float>(std::min(value, 1e30));
    }
  }
  return image;
}

}  // namespace hyades::core
