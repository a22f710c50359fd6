#include "study/sweep/definition/sample_points.h"

#include <array>
#include <numeric>
#include <utility>

#include "base/math/random.h"

namespace emscape::study {
namespace {

/// Rows of new-joe-kuo-6 for dimensions 2 to 21: degree and coefficients of the primitive polynomial, and the
/// initial direction numbers.
struct SobolRow {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 7> initial;
};
constexpr std::array<SobolRow, kMaxSobolDimensions - 1> kSobolRows{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};
constexpr int kBits = 32;

std::array<std::uint32_t, kBits> directionNumbers(int dimension) {
  std::array<std::uint32_t, kBits> numbers{};
  if (dimension == 0) {
    for (int b = 0; b < kBits; ++b) numbers[b] = 1u << (kBits - 1 - b);
    return numbers;
  }
  const SobolRow& row = kSobolRows[static_cast<std::size_t>(dimension) - 1];
  for (int b = 0; b < kBits; ++b) {
    if (b < row.degree) {
      numbers[b] = row.initial[b] << (kBits - 1 - b);
      continue;
    }
    numbers[b] = numbers[b - row.degree] ^ (numbers[b - row.degree] >> row.degree);
    for (int k = 1; k < row.degree; ++k) {
      if ((row.coefficients >> (row.degree - 1 - k) & 1u) != 0) numbers[b] ^= numbers[b - k];
    }
  }
  return numbers;
}

/// Purpose of a random number: part of the counter, so that no two purposes share numbers.
enum class Stream : std::uint32_t { position, permutation, shift };

std::array<std::uint32_t, 4> randomWords(std::uint64_t seed, Stream stream, int dimension, int index) {
  return philox4x32({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(dimension),
                     static_cast<std::uint32_t>(stream), 0},
                    {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
}

}  // namespace

SamplePoints latinHypercube(int count, int dimensions, std::uint64_t seed) {
  SamplePoints points{count, dimensions, {}};
  points.coordinates.resize(static_cast<std::size_t>(count) * static_cast<std::size_t>(dimensions));
  std::vector<int> interval(static_cast<std::size_t>(count));
  for (int d = 0; d < dimensions; ++d) {
    std::iota(interval.begin(), interval.end(), 0);
    for (int i = count - 1; i > 0; --i) {  // Fisher and Yates
      const std::uint64_t word = randomWords(seed, Stream::permutation, d, i)[0];
      std::swap(interval[i], interval[word * (static_cast<std::uint64_t>(i) + 1) >> 32]);
    }
    for (int i = 0; i < count; ++i) {
      points.coordinates[static_cast<std::size_t>(i) * dimensions + d] =
          (interval[i] + fractionOf(randomWords(seed, Stream::position, d, i)[0])) / count;
    }
  }
  return points;
}

std::vector<std::uint32_t> sobolWords(int count, int dimensions) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(count) * static_cast<std::size_t>(dimensions));
  for (int d = 0; d < dimensions; ++d) {
    const std::array<std::uint32_t, kBits> directions = directionNumbers(d);
    std::uint32_t word = 0;
    for (int i = 0; i < count; ++i) {
      words[static_cast<std::size_t>(i) * dimensions + d] = word;
      int lowest_zero = 0;
      while ((static_cast<std::uint32_t>(i) >> lowest_zero & 1u) != 0) ++lowest_zero;
      word ^= directions[lowest_zero];
    }
  }
  return words;
}

SamplePoints sobolPoints(int count, int dimensions, std::uint64_t seed) {
  SamplePoints points{count, dimensions, {}};
  const std::vector<std::uint32_t> words = sobolWords(count, dimensions);
  points.coordinates.reserve(words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    const int d = static_cast<int>(i % static_cast<std::size_t>(dimensions));
    points.coordinates.push_back(fractionOf(words[i] ^ randomWords(seed, Stream::shift, d, 0)[0]));
  }
  return points;
}

}  // namespace emscape::study
