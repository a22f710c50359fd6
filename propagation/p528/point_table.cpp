#include "propagation/p528/point_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/p528/excess.h"

namespace emscape::propagation {
namespace {

/// Cells of the first level, in each direction.
constexpr int kCells = 64;
constexpr int kDeepest = 10;  ///< levels below
/// Positions of nodes within a cell of the first level, in whole numbers.
constexpr int kUnits = 4 << kDeepest;
/// Points for which a cell is not worth its first nodes, and for which it is not worth to check and divide
/// it.
constexpr std::ptrdiff_t kFewForNodes = 12, kFewForCheck = 4;
/// Largest difference (dB) at the points of a check, a fifth of the accuracy.
constexpr double kTolerance_db = 0.002;
constexpr int kHorizons = 257;

}  // namespace

/// A point in the table.
struct P528PointTable::Place {
  float along, up;  ///< 0..1
  std::uint32_t index;
};

/// The cells of a range of heights; one thread at a time.
class P528PointTable::Row {
 public:
  Row() : cells_(kCells) {}

  /// Sets the excess of points in a cell of the first level.
  void fill(const P528PointTable& table, int row, int column, Place* begin, Place* end,
            const std::function<Point(std::size_t)>& pointOf, float* excess_db) {
    fillCell({table, row, column, pointOf, excess_db}, column, {0, 0, kUnits}, begin, end);
  }
  std::size_t evaluations() const { return evaluations_; }

 private:
  enum class State : char { empty, open, smooth, divided };
  struct Cell {
    State state = State::empty;
    int first_child = 0;
    /// Open: the model at the corners, edges and middle, by height, then range. Smooth: coefficients of
    /// the polynomial of both positions, -1..1.
    std::array<float, 9> values;
  };
  /// Corner and side of a cell.
  struct Square {
    int along, up, side;
  };
  struct Task {
    const P528PointTable& table;
    int row, column;
    const std::function<Point(std::size_t)>& pointOf;
    float* excess_db;
  };

  void fillCell(const Task& task, int index, const Square& square, Place* begin, Place* end);
  void divide(const Task& task, int index, const Square& square, const float* five_by_five);
  float nodeOf(const Task& task, int along, int up);

  std::vector<Cell> cells_;
  std::unordered_map<int, P528Curve> curves_;  ///< by position of the height
  std::size_t evaluations_ = 0;
};

namespace {

/// Coefficients of the polynomial through the values of `values` at -1, 0, 1 in both directions.
std::array<float, 9> polynomialThrough(const std::array<float, 9>& values) {
  std::array<double, 9> rows;
  std::array<float, 9> result;
  for (int j = 0; j < 3; ++j) {
    const double low = static_cast<double>(values[3 * j]), middle = static_cast<double>(values[3 * j + 1]),
                 high = static_cast<double>(values[3 * j + 2]);
    rows[3 * j] = middle;
    rows[3 * j + 1] = (high - low) / 2;
    rows[3 * j + 2] = (high + low) / 2 - middle;
  }
  for (int i = 0; i < 3; ++i) {
    const double low = rows[i], middle = rows[3 + i], high = rows[6 + i];
    result[i] = static_cast<float>(middle);
    result[3 + i] = static_cast<float>((high - low) / 2);
    result[6 + i] = static_cast<float>((high + low) / 2 - middle);
  }
  return result;
}

float valueAt(const std::array<float, 9>& c, float along, float up) {
  const auto row = [&](int j) { return c[j] + along * (c[j + 1] + along * c[j + 2]); };
  return row(0) + up * (row(3) + up * row(6));
}

}  // namespace

void P528PointTable::Row::fillCell(const Task& task, int index, const Square& square, Place* begin,
                                   Place* end) {
  if (begin == end) return;
  const float per_unit = static_cast<float>(2.0 * kUnits * kCells / square.side);
  const float middle_along =
      static_cast<float>((task.column + (square.along + square.side / 2.0) / kUnits) / kCells);
  const float middle_up = static_cast<float>((task.row + (square.up + square.side / 2.0) / kUnits) / kCells);
  if (cells_[index].state == State::empty || cells_[index].state == State::open) {
    const std::ptrdiff_t few = cells_[index].state == State::empty ? kFewForNodes : kFewForCheck;
    if (end - begin <= few || square.side < 4) {
      for (const Place* place = begin; place < end; ++place) {
        task.excess_db[place->index] = task.table.modelAt(task.pointOf(place->index));
        ++evaluations_;
      }
      return;
    }
    const int half = square.side / 2, quarter = square.side / 4;
    if (cells_[index].state == State::empty) {
      std::array<float, 9> values;
      for (int n = 0; n < 9; ++n) {
        values[n] = nodeOf(task, square.along + n % 3 * half, square.up + n / 3 * half);
      }
      cells_[index].values = values;
      cells_[index].state = State::open;
    }
    const std::array<float, 9> polynomial = polynomialThrough(cells_[index].values);
    float five_by_five[25];
    bool is_smooth = true;
    for (int j = 1; j < 5; j += 2) {
      for (int i = 1; i < 5; i += 2) {
        const float value = nodeOf(task, square.along + i * quarter, square.up + j * quarter);
        five_by_five[5 * j + i] = value;
        const float line = valueAt(polynomial, static_cast<float>(i - 2) / 2, static_cast<float>(j - 2) / 2);
        is_smooth = is_smooth && std::fabs(static_cast<double>(value - line)) < kTolerance_db;
      }
    }
    if (is_smooth) {
      cells_[index].values = polynomial;
      cells_[index].state = State::smooth;
    } else {
      divide(task, index, square, five_by_five);
    }
  }
  if (cells_[index].state == State::smooth) {
    const std::array<float, 9> polynomial = cells_[index].values;
    for (const Place* place = begin; place < end; ++place) {
      task.excess_db[place->index] =
          valueAt(polynomial, (place->along - middle_along) * per_unit, (place->up - middle_up) * per_unit);
    }
    return;
  }
  const int half = square.side / 2, first = cells_[index].first_child;
  Place* const upper = std::partition(begin, end, [&](const Place& p) { return p.up < middle_up; });
  Place* const ends[3] = {begin, upper, end};
  for (int j = 0; j < 2; ++j) {
    Place* const farther =
        std::partition(ends[j], ends[j + 1], [&](const Place& p) { return p.along < middle_along; });
    const Square nearer{square.along, square.up + j * half, half};
    fillCell(task, first + 2 * j, nearer, ends[j], farther);
    fillCell(task, first + 2 * j + 1, {nearer.along + half, nearer.up, half}, farther, ends[j + 1]);
  }
}

/// @param five_by_five  the model at every quarter; those of odd row and column are set
void P528PointTable::Row::divide(const Task& task, int index, const Square& square,
                                 const float* five_by_five) {
  float nodes[25];
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) {
      const int quarter = square.side / 4;
      nodes[5 * j + i] = i % 2 == 1 && j % 2 == 1 ? five_by_five[5 * j + i]
                         : i % 2 == 0 && j % 2 == 0
                             ? cells_[index].values[3 * (j / 2) + i / 2]
                             : nodeOf(task, square.along + i * quarter, square.up + j * quarter);
    }
  }
  const int first = static_cast<int>(cells_.size());
  cells_[index].state = State::divided;
  cells_[index].first_child = first;
  cells_.resize(cells_.size() + 4);
  for (int child = 0; child < 4; ++child) {
    Cell& cell = cells_[first + child];
    cell.state = State::open;
    for (int n = 0; n < 9; ++n) {
      cell.values[n] = nodes[5 * (child / 2 * 2 + n / 3) + child % 2 * 2 + n % 3];
    }
  }
}

/// The model at a node, in units of a cell of the first level.
float P528PointTable::Row::nodeOf(const Task& task, int along, int up) {
  const P528PointTable& table = task.table;
  ++evaluations_;
  const double up_part = (task.row + static_cast<double>(up) / kUnits) / kCells;
  const double along_part = (task.column + static_cast<double>(along) / kUnits) / kCells;
  const double root = table.lowest_root_ + up_part * table.span_root_;
  auto curve = curves_.find(up);
  if (curve == curves_.end()) curve = curves_.emplace(up, table.curveOf(root * root)).first;
  return table.excessAt(curve->second, p528RangeAt(along_part, table.horizonOf_m(root),
                                                   table.steepOf_m(root * root), table.farthest_ratio_));
}

P528PointTable::P528PointTable(const EmitterInputs& emitter, double tx_m, double lowest_m, double highest_m,
                               double farthest_m)
    : atmosphere_(std::make_shared<const P528Atmosphere>(emitter.frequency_hz)),
      frequency_hz_(emitter.frequency_hz),
      vertical_(emitter.polarization != Polarization::horizontal),
      time_percent_(emitter.settings.p528.time_percent),
      tx_(p528Terminal(*atmosphere_, tx_m)),
      lowest_root_(std::sqrt(lowest_m)),
      span_root_(std::max(std::sqrt(highest_m) - lowest_root_, 1e-3)),
      rows_(kCells) {
  for (int n = 0; n < kHorizons; ++n) {
    const double root = lowest_root_ + span_root_ * n / (kHorizons - 1);
    horizons_m_.push_back(curveOf(root * root).horizon_m());
  }
  farthest_ratio_ = std::max(1.1, farthest_m / horizons_m_.front());
}

P528PointTable::~P528PointTable() = default;

P528Curve P528PointTable::curveOf(double height_m) const {
  const double allowed_m = std::clamp(height_m, kP528Height.min, kP528Height.max);
  return {atmosphere_, frequency_hz_, tx_, p528Terminal(*atmosphere_, allowed_m), vertical_};
}

float P528PointTable::excessAt(const P528Curve& curve, double range_m) const {
  const P528Loss loss = curve.at(range_m, time_percent_);
  return static_cast<float>(loss.loss_db - loss.free_space_db);
}

float P528PointTable::modelAt(const Point& point) const {
  return excessAt(curveOf(point.height_m), point.range_m);
}

double P528PointTable::horizonOf_m(double root) const {
  const double at = std::clamp((root - lowest_root_) / span_root_, 0.0, 1.0) * (kHorizons - 1);
  const int before = std::min(static_cast<int>(at), kHorizons - 2);
  return horizons_m_[before] + (at - before) * (horizons_m_[before + 1] - horizons_m_[before]);
}

double P528PointTable::steepOf_m(double height_m) const {
  return kP528SteepRatio * (1000 * tx_.height_km + height_m);
}

void P528PointTable::fill(std::size_t count, const std::function<Point(std::size_t)>& pointOf,
                          float* excess_db) {
  constexpr int kPart = 1 << 14;
  // Places, sorted by cell of the first level.
  const int parts = static_cast<int>((count + kPart - 1) / kPart);
  std::vector<Place> unsorted(count), sorted(count);
  std::vector<std::uint16_t> cell_of(count);
  constexpr std::uint16_t kNone = kCells * kCells;
  parallelFor(parts, 1, [&](int begin, int end) {
    const std::size_t last = std::min(count, static_cast<std::size_t>(end) * kPart);
    for (std::size_t i = static_cast<std::size_t>(begin) * kPart; i < last; ++i) {
      const Point point = pointOf(i);
      cell_of[i] = kNone;
      if (std::isnan(point.range_m)) continue;
      const double root = std::sqrt(point.height_m);
      const double up = (root - lowest_root_) / span_root_;
      const double along = P528Excess::positionOf(point.range_m, horizonOf_m(root), steepOf_m(point.height_m),
                                                  farthest_ratio_);
      unsorted[i] = {static_cast<float>(along), static_cast<float>(up), static_cast<std::uint32_t>(i)};
      const auto cellOf = [](float position) {
        return std::clamp(static_cast<int>(position * kCells), 0, kCells - 1);
      };
      cell_of[i] = static_cast<std::uint16_t>(cellOf(unsorted[i].up) * kCells + cellOf(unsorted[i].along));
    }
  });
  std::vector<std::size_t> first(kNone + 2);
  for (const std::uint16_t cell : cell_of) ++first[cell + 1];
  for (std::size_t cell = 0; cell < kNone; ++cell) first[cell + 1] += first[cell];
  std::vector<std::size_t> next(first.begin(), first.end());
  for (std::size_t i = 0; i < count; ++i) {
    if (cell_of[i] != kNone) sorted[next[cell_of[i]]++] = unsorted[i];
  }
  parallelFor(kCells, 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int column = 0; column < kCells; ++column) {
        checkpoint();
        const int cell = row * kCells + column;
        rows_[row].fill(*this, row, column, sorted.data() + first[cell], sorted.data() + first[cell + 1],
                        pointOf, excess_db);
      }
    }
  });
}

std::size_t P528PointTable::evaluations() const {
  std::size_t sum = 0;
  for (const Row& row : rows_) sum += row.evaluations();
  return sum;
}

}  // namespace emscape::propagation
