#include "core/film/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <random>
#include <set>
#include <tuple>

namespace hyades::core {
namespace {

using Cell = std::tuple<int, int, uint32_t>;

CoverageBox box(int x0, int y0, int x1, int y1, uint32_t first, uint32_t count) {
  return {{x0, y0, x1, y1}, {first, count}};
}

std::set<Cell> cells_of(const std::vector<CoverageBox>& boxes) {
  std::set<Cell> cells;
  for (const CoverageBox& b : boxes) {
    for (int y = b.tile.y0; y < b.tile.y1; ++y) {
      for (int x = b.tile.x0; x < b.tile.x1; ++x) {
        for (uint32_t k = b.batches.first; k < b.batches.end(); ++k) {
          EXPECT_TRUE(cells.insert({x, y, k}).second) << "boxes overlap";
        }
      }
    }
  }
  return cells;
}

/// Cuts a box at random into pieces, in random order.
std::vector<CoverageBox> cut(const CoverageBox& whole, int cuts, std::mt19937& random) {
  std::vector<CoverageBox> pieces = {whole};
  for (int i = 0; i < cuts; ++i) {
    const size_t at = random() % pieces.size();
    CoverageBox a = pieces[at];
    CoverageBox b = a;
    switch (random() % 3) {
      case 0:
        if (a.tile.width() < 2) continue;
        a.tile.x1 = b.tile.x0 = a.tile.x0 + 1 + static_cast<int>(random() % (a.tile.width() - 1));
        break;
      case 1:
        if (a.tile.height() < 2) continue;
        a.tile.y1 = b.tile.y0 = a.tile.y0 + 1 + static_cast<int>(random() % (a.tile.height() - 1));
        break;
      default:
        if (a.batches.count < 2) continue;
        a.batches.count = 1 + random() % (a.batches.count - 1);
        b.batches.first = a.batches.end();
        b.batches.count -= a.batches.count;
    }
    pieces[at] = a;
    pieces.push_back(b);
  }
  std::shuffle(pieces.begin(), pieces.end(), random);
  return pieces;
}

TEST(Coverage, JoinsNeighboursInAllThreeDirections) {
  Coverage c;
  c.add(box(0, 0, 8, 8, 0, 2));
  c.add(box(0, 0, 8, 8, 2, 2));
  c.add(box(8, 0, 16, 8, 0, 4));
  c.add(box(0, 8, 16, 16, 0, 4));
  ASSERT_EQ(c.boxes().size(), 1U);
  EXPECT_EQ(c.boxes()[0], box(0, 0, 16, 16, 0, 4));
  EXPECT_EQ(c.volume(), 16U * 16 * 4);
  EXPECT_EQ(c.canonical(), c.boxes());
}

TEST(Coverage, FindsOverlapAndContainment) {
  Coverage c;
  EXPECT_FALSE(c.overlap(box(0, 0, 4, 4, 0, 1)));
  EXPECT_TRUE(c.contains(box(0, 0, 0, 0, 0, 1)));
  c.add(box(0, 0, 8, 8, 0, 2));
  c.add(box(8, 0, 12, 4, 0, 1));
  EXPECT_EQ(c.overlap(box(4, 4, 16, 16, 1, 5)), box(4, 4, 8, 8, 1, 1));
  EXPECT_FALSE(c.overlap(box(0, 0, 8, 8, 2, 1)));
  EXPECT_FALSE(c.overlap(box(8, 4, 9, 5, 0, 1)));
  EXPECT_TRUE(c.contains(box(4, 0, 12, 4, 0, 1)));
  EXPECT_FALSE(c.contains(box(4, 0, 12, 4, 0, 2)));
  EXPECT_FALSE(c.contains(box(4, 0, 12, 5, 0, 1)));
}

TEST(Coverage, CanonicalFormDependsOnTheSetAlone) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    // A set of several separate boxes with holes: keep some pieces of a cut box.
    std::vector<CoverageBox> kept = cut(box(-3, 2, 17, 15, 0, 9), 40, random);
    kept.resize(kept.size() / 2);
    std::vector<CoverageBox> first_form;
    for (int way = 0; way < 6; ++way) {
      std::vector<CoverageBox> pieces;
      for (const CoverageBox& b : kept) {
        const auto parts = cut(b, static_cast<int>(random() % 20), random);
        pieces.insert(pieces.end(), parts.begin(), parts.end());
      }
      std::shuffle(pieces.begin(), pieces.end(), random);
      Coverage c;
      for (const CoverageBox& b : pieces) {
        ASSERT_FALSE(c.overlap(b));
        c.add(b);
        ASSERT_TRUE(c.contains(b));
      }
      ASSERT_EQ(cells_of(c.boxes()), cells_of(kept));
      if (way == 0) {
        first_form = c.canonical();
        ASSERT_EQ(cells_of(first_form), cells_of(kept));
      } else {
        ASSERT_EQ(c.canonical(), first_form);
      }
    }
  }
}

TEST(Coverage, DifferentSetsDiffer) {
  Coverage a;
  Coverage b;
  a.add(box(0, 0, 4, 4, 0, 2));
  b.add(box(0, 0, 4, 4, 1, 2));
  EXPECT_NE(a.canonical(), b.canonical());
}

/// Every answer equals that of a set of cells, with enough boxes that the index is in use and tall
/// boxes and faraway ones among them.
TEST(Coverage, AnswersAsASetOfCellsDoes) {
  std::mt19937 random(11);
  std::vector<CoverageBox> pieces = cut(box(0, -40, 4, 360, 0, 4), 400, random);
  pieces.resize(pieces.size() * 3 / 4);
  Coverage c;
  std::set<Cell> cells;
  c.add(box(0, 1000000, 3, 1000002, 0, 1));
  c.add(box(0, -9000000, 1, -8000000, 0, 1));
  for (const CoverageBox& b : pieces) c.add(b);
  for (const CoverageBox& b : pieces) cells.merge(cells_of({b}));
  EXPECT_TRUE(c.overlap(box(2, 1000001, 3, 1000002, 0, 9)));
  EXPECT_TRUE(c.overlap(box(0, -8500000, 3, -8499999, 0, 9)));
  for (int i = 0; i < 4000; ++i) {
    const int x = static_cast<int>(random() % 4);
    const int y = static_cast<int>(random() % 400) - 40;
    const CoverageBox ask =
        box(x, y, x + 1 + static_cast<int>(random() % 2), y + 1 + static_cast<int>(random() % 3),
            random() % 4, 1 + random() % 2);
    size_t held = 0;
    for (const Cell& cell : cells_of({ask})) held += cells.count(cell);
    const auto overlap = c.overlap(ask);
    ASSERT_EQ(overlap.has_value(), held > 0);
    if (overlap) {
      for (const Cell& cell : cells_of({*overlap})) ASSERT_TRUE(cells.count(cell));
    }
    ASSERT_EQ(c.contains(ask), held == cells_of({ask}).size());
  }
}

TEST(Coverage, ReadsCanonicalFormsOnly) {
  std::mt19937 random(9);
  for (int round = 0; round < 30; ++round) {
    std::vector<CoverageBox> pieces = cut(box(-30, -2, 170, 150, 3, 9), 200, random);
    pieces.resize(pieces.size() / 2);
    Coverage c;
    for (const CoverageBox& b : pieces) c.add(b);
    const std::vector<CoverageBox> form = c.canonical();
    const auto read = Coverage::from_canonical(form);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->boxes(), form);
    EXPECT_EQ(read->volume(), c.volume());
    EXPECT_EQ(read->overlap(pieces[7]).has_value(), true);
    std::vector<CoverageBox> wrong = form;
    std::swap(wrong[0], wrong[1]);
    EXPECT_FALSE(Coverage::from_canonical(wrong).ok()) << "another order";
    wrong = form;
    wrong[1] = wrong[0];
    EXPECT_FALSE(Coverage::from_canonical(wrong).ok()) << "overlap";
    wrong = form;
    wrong[0].batches.count = 0;
    EXPECT_FALSE(Coverage::from_canonical(wrong).ok()) << "empty";
    wrong = form;
    wrong.back().batches.count = ~0U;
    EXPECT_FALSE(Coverage::from_canonical(wrong).ok()) << "batch numbers wrap around";
  }
  EXPECT_TRUE(Coverage::from_canonical({})->boxes().empty());
}

/// Boxes that cut each other into n^2 or n^3 pieces.
TEST(Coverage, HostileBoxesAreRefusedAtOnce) {
  std::vector<CoverageBox> columns;
  std::vector<CoverageBox> stairs;
  for (int i = 0; i < 50000; ++i) {
    columns.push_back(box(i, 0, 100000, 1, static_cast<uint32_t>(i) * 2, 1));
    stairs.push_back(box(i, i, i + 1, 100000, 0, 1));
  }
  const std::clock_t start = std::clock();
  EXPECT_FALSE(Coverage::from_canonical(columns).ok());
  EXPECT_FALSE(Coverage::from_canonical(stairs).ok());
  EXPECT_LT(std::clock() - start, 5 * CLOCKS_PER_SEC);
}

/// A 1080p frame in tiles of 32 x 32 whose batches arrive one by one in random order. It takes
/// some 90 ms of processor time.
TEST(Coverage, ThirtyThousandBoxesInRandomOrderAreCheap) {
  std::mt19937 random(5);
  std::vector<CoverageBox> pieces;
  for (int y = 0; y < 1080; y += 32) {
    for (int x = 0; x < 1920; x += 32) {
      for (uint32_t b = 0; b < 16; ++b) {
        pieces.push_back(box(x, y, x + 32, std::min(y + 32, 1080), b * 4, 4));
      }
    }
  }
  std::shuffle(pieces.begin(), pieces.end(), random);
  const std::clock_t start = std::clock();
  Coverage c;
  size_t most = 0;
  for (const CoverageBox& b : pieces) {
    ASSERT_FALSE(c.overlap(b));
    c.add(b);
    most = std::max(most, c.boxes().size());
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", static_cast<int>(seconds * 1000));
  RecordProperty("most_boxes", static_cast<int>(most));
  EXPECT_EQ(c.canonical(), std::vector{box(0, 0, 1920, 1080, 0, 64)});
  EXPECT_LT(c.boxes().size(), 400U);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(seconds, 1.0);
#endif
}

}  // namespace
}  // namespace hyades::core
