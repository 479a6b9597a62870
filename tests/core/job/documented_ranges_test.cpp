#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/job/job.h"

/// Holds the columns of units and ranges of docs/job.md against the lists of keys.
namespace hyades::core {
namespace {

/// Collects the ranges of all keys that take numbers, by section and key.
class RangesIn : public FieldVisitor<RangesIn> {
 public:
  using FieldVisitor::choice;
  using FieldVisitor::map;

  template <class Desc>
  void read(const std::string& section, const Desc& desc) {
    section_ = section;
    Desc::fields(desc, *this);
  }

  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}
  void enter_section(std::string_view section) { section_ = section; }
  void number(const KeyName& key, float /*value*/, const Range& range) { note(key, range); }
  template <class T>
  void integer(const KeyName& key, T /*value*/, int64_t low, int64_t high) {
    note(key, {static_cast<double>(low), static_cast<double>(high)});
  }
  void integer(const KeyName& /*key*/, uint64_t /*value*/) {}
  template <class T>
  void animated(const KeyName& key, const T& /*value*/, const Range& range) {
    note(key, range);
  }
  template <class T>
  void animated_scale(const KeyName& key, const T& /*value*/, const Range& range) {
    note(key, range);
  }
  template <class T>
  void color(const KeyName& key, const T& /*value*/, const Range& range) {
    note(key, range);
  }
  template <class T>
  void color_input(const KeyName& key, const T& /*value*/, const Range& range) {
    note(key, range);
  }
  template <class T>
  void scalar_input(const KeyName& key, const T& /*value*/, const Range& range) {
    note(key, range);
  }
  template <class Unit, class T>
  void either(const KeyName& a, const Range& a_range, const KeyName& b, const Range& b_range,
              Unit /*unit*/, const T& /*value*/) {
    note(a, a_range);
    note(b, b_range);
  }
  template <class Desc>
  void map(const KeyName& /*key*/, const char* section, const Desc& desc) {
    const std::string outside = std::exchange(section_, section);
    Desc::fields(desc, *this);
    section_ = outside;
  }
  template <class Desc>
  void map(const KeyName& key, const char* section, const std::optional<Desc>& /*desc*/) {
    map(key, section, Desc());
  }

  std::map<std::pair<std::string, std::string>, Range> ranges;

 private:
  void note(const KeyName& key, const Range& range) {
    ranges[{section_, std::string(key.name)}] = range;
  }

  std::string section_;
};

template <class Desc>
void read_kinds(RangesIn& all, const std::string& section) {
  using Kinds = KindsOf<decltype(Desc::kind)>;
  for (size_t i = 0; i < Kinds::names().size(); ++i) {
    Desc desc;
    desc.kind = Kinds::make(i);
    all.read(section + "." + Kinds::names()[i], desc);
  }
}

RangesIn all_ranges() {
  RangesIn all;
  read_kinds<TextureDesc>(all, "textures");
  read_kinds<MaterialDesc>(all, "materials");
  read_kinds<LightDesc>(all, "lights");
  all.read("media", MediumDesc());
  all.read("environment", EnvironmentDesc());
  all.read("film", FilmDesc());
  all.read("sampling", SamplingDesc());
  all.read("render", RenderDesc());
  all.read("camera.exposure", ExposureDesc());
  for (const std::string& type : kCameraTypes) {
    CameraDesc camera;
    camera.type = type;
    all.read("camera." + type, camera);
  }
  for (const std::string& type : kIntegratorTypes) {
    IntegratorDesc integrator;
    integrator.type = type;
    all.read("integrator." + type, integrator);
  }
  for (const char* shape : {"sphere", "rectangle", "disk", "box", "cylinder", "mesh"}) {
    ObjectDesc object;
    object.shape = shape;
    all.read("objects", object);
  }
  return all;
}

std::string without_spaces(const std::string& text) {
  const size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

/// What a cell of the page says: "0 to 1", "0, or 3 to 64", "above 0, below 180", ">= 0"; any
/// number where it says nothing.
Range read_range(const std::string& cell) {
  static const std::string kNumber = "(-?[0-9.]+(?:e-?[0-9]+)?)";
  std::smatch found;
  if (std::regex_search(
          cell, found,
          std::regex("^above " + kNumber + "(?:, (at most|below) " + kNumber + ")?"))) {
    const bool ends = found[2].matched;
    return {std::stod(found[1]), ends ? std::stod(found[3]) : kAnyNumber.high, true,
            ends && found[2] == "below"};
  }
  if (std::regex_search(cell, found, std::regex("^>= " + kNumber)))
    return {std::stod(found[1]), kAnyNumber.high};
  if (std::regex_search(cell, found, std::regex(kNumber + " to " + kNumber + "(?!\\^)"))) {
    return {cell.starts_with("0, or") ? 0.0 : std::stod(found[1]), std::stod(found[2])};
  }
  return kAnyNumber;
}

TEST(DocumentedRanges, AreThoseOfTheListsOfKeys) {
  const RangesIn all = all_ranges();
  std::ifstream page("docs/job.md");
  ASSERT_TRUE(page.good());
  std::vector<std::string> sections;
  int checked = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) {
      sections.clear();
      std::stringstream parts(line);
      for (std::string part; std::getline(parts, part, '`') && std::getline(parts, part, '`');)
        sections.push_back(part);
    }
    std::stringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(without_spaces(cell));
    if (!line.starts_with("|") || cells.size() != 8) continue;
    for (const std::string& section : sections) {
      const auto found = all.ranges.find({section, cells[1]});
      if (found == all.ranges.end()) continue;
      SCOPED_TRACE(section + " / " + cells[1] + ": " + cells[5]);
      const Range& range = found->second;
      const Range said = read_range(cells[5]);
      EXPECT_EQ(said.low, range.low);
      EXPECT_EQ(said.high, range.high);
      EXPECT_EQ(said.low_open, range.low_open);
      EXPECT_EQ(said.high_open, range.high_open);
      if (*range.unit != '\0') {
        EXPECT_EQ(cells[3], range.unit);
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 150);
}

}  // namespace
}  // namespace hyades::core
