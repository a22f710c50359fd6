/// Sine transform of several azimuths at once, one per vector lane.
///
/// S(u)[n] = sum over j = 1..N-1 of u[j] sin(pi j n / N), n = 1..N-1, N a power of two; S(S(u)) = N/2 u.
///
/// The outputs of even n are the transform of half the length of u[j] - u[N-j]; those of odd n are a cosine
/// transform (DCT-III) of half the length of u[j] + u[N-j], which is one complex FFT of that length. So the
/// work is that of a complex FFT of N points, without the running sums over n of the usual method, whose
/// rounding errors grow with N. Our own code, since the libraries transform one lane after another, or pairs
/// of real arrays only, and do not compile for a GPU.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "emscape/base/units.h"
#include "propagation/complex.h"

namespace emscape::propagation {

/// A complex number of each lane, at one height.
template <class Real, int kLanes>
struct LaneComplex {
  Real re[kLanes];
  Real im[kLanes];
};

template <class Real, int kLanes>
inline LaneComplex<Real, kLanes> operator+(const LaneComplex<Real, kLanes>& a,
                                           const LaneComplex<Real, kLanes>& b) {
  LaneComplex<Real, kLanes> sum;
  for (int l = 0; l < kLanes; ++l) sum.re[l] = a.re[l] + b.re[l];
  for (int l = 0; l < kLanes; ++l) sum.im[l] = a.im[l] + b.im[l];
  return sum;
}
template <class Real, int kLanes>
inline LaneComplex<Real, kLanes> operator-(const LaneComplex<Real, kLanes>& a,
                                           const LaneComplex<Real, kLanes>& b) {
  LaneComplex<Real, kLanes> difference;
  for (int l = 0; l < kLanes; ++l) difference.re[l] = a.re[l] - b.re[l];
  for (int l = 0; l < kLanes; ++l) difference.im[l] = a.im[l] - b.im[l];
  return difference;
}
/// Multiplies all lanes by one number.
template <class Real, int kLanes>
inline LaneComplex<Real, kLanes> operator*(const LaneComplex<Real, kLanes>& a, Complex<Real> b) {
  LaneComplex<Real, kLanes> product;
  for (int l = 0; l < kLanes; ++l) product.re[l] = a.re[l] * b.re - a.im[l] * b.im;
  for (int l = 0; l < kLanes; ++l) product.im[l] = a.re[l] * b.im + a.im[l] * b.re;
  return product;
}
/// Lane by lane.
template <class Real, int kLanes>
inline LaneComplex<Real, kLanes> operator*(const LaneComplex<Real, kLanes>& a,
                                           const LaneComplex<Real, kLanes>& b) {
  LaneComplex<Real, kLanes> product;
  for (int l = 0; l < kLanes; ++l) product.re[l] = a.re[l] * b.re[l] - a.im[l] * b.im[l];
  for (int l = 0; l < kLanes; ++l) product.im[l] = a.re[l] * b.im[l] + a.im[l] * b.re[l];
  return product;
}
/// i a.
template <class Real, int kLanes>
inline LaneComplex<Real, kLanes> timesI(const LaneComplex<Real, kLanes>& a) {
  LaneComplex<Real, kLanes> turned;
  for (int l = 0; l < kLanes; ++l) turned.re[l] = -a.im[l];
  for (int l = 0; l < kLanes; ++l) turned.im[l] = a.re[l];
  return turned;
}

/// Tables and memory for transforms of one length. A thread needs its own.
template <class Real, int kLanes>
class SineTransform {
 public:
  using Value = LaneComplex<Real, kLanes>;

  /// @param intervals  N, a power of two, 2 or more
  explicit SineTransform(int intervals)
      : n_(intervals), turns_(2 * std::size_t(intervals)), a_(intervals / 2), b_(intervals / 2) {
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const double angle = kPi * double(i) / n_;
      turns_[i] = {Real(std::cos(angle)), Real(std::sin(angle))};
    }
  }

  int intervals() const { return n_; }

  /// @param u    N values, of which u[0] is not read; destroyed
  /// @param out  N values; out[0] is 0
  void operator()(Value* u, Value* out) {
    out[0] = Value{};
    for (int n = n_, stride = 1; n >= 2; n /= 2, stride *= 2) {
      const int m = n / 2;
      // c[j] = u[m - j] + u[m + j], c[0] = u[m], c[m] = 0 here: the cosine transform's input
      a_[0] = u[m];
      for (int j = 1; j < m; ++j) {
        const Value c = u[m - j] + u[m + j], mirrored = u[j] + u[n - j];
        a_[j] = (c - timesI(mirrored)) * half(turns_[std::size_t(j) * (n_ / n)]);
      }
      for (int j = 1; j < m; ++j) u[j] = u[j] - u[n - j];
      const Value* x = fourier(m);
      Value* odd = out + stride;
      for (int k = 0; k < m;
           ++k) {  // x holds the outputs of even k ascending, then those of odd k descending
        const Value value = k % 2 == 0 ? x[k / 2] : x[m - 1 - k / 2];
        odd[std::size_t(2 * k) * stride] = k % 2 == 0 ? value : Value{} - value;
      }
    }
  }

 private:
  static Complex<Real> half(Complex<Real> a) { return {a.re / 2, a.im / 2}; }

  /// Sum over j of a[j] exp(+2 pi i j k / m), k = 0..m-1, in one of the two buffers: Stockham's form,
  /// radix 4.
  const Value* fourier(int m) {
    Value *x = a_.data(), *y = b_.data();
    int stride = 1;
    for (; m >= 4; m /= 4, stride *= 4) {
      const int quarter = m / 4;
      const std::size_t turn = std::size_t(2 * n_ / m);
      for (int p = 0; p < quarter; ++p) {
        const Complex<Real> w1 = turns_[p * turn], w2 = turns_[2 * p * turn], w3 = turns_[3 * p * turn];
        for (int q = 0; q < stride; ++q) {
          const Value* in = x + q + stride * p;
          Value* to = y + q + stride * 4 * p;
          const Value a = in[0], b = in[stride * quarter], c = in[2 * stride * quarter],
                      d = in[3 * stride * quarter];
          const Value ac = a + c, a_c = a - c, bd = b + d, ib_d = timesI(b - d);
          to[0] = ac + bd;
          to[stride] = (a_c + ib_d) * w1;
          to[2 * stride] = (ac - bd) * w2;
          to[3 * stride] = (a_c - ib_d) * w3;
        }
      }
      std::swap(x, y);
    }
    if (m == 2) {
      for (int q = 0; q < stride; ++q) {
        y[q] = x[q] + x[q + stride];
        y[q + stride] = x[q] - x[q + stride];
      }
      std::swap(x, y);
    }
    return x;
  }

  int n_;
  std::vector<Complex<Real>> turns_;  ///< exp(2 pi i k / 2N)
  std::vector<Value> a_, b_;
};

}  // namespace emscape::propagation
