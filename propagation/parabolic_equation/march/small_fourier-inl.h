// SmallFourier for the types Complex, ScalarOf and the operators of the namespace that includes this file.

/// x[k] <- sum over j of x[j] exp(kSign 2 pi i j k / kPoints), all in natural order.
template <int kPoints, int kSign, class Real>
struct SmallFourier;

template <int kSign, class Real>
struct SmallFourier<1, kSign, Real> {
  static EMSCAPE_HD void run(Complex<Real>*) {}
};

template <int kSign, class Real>
struct SmallFourier<2, kSign, Real> {
  static EMSCAPE_HD void run(Complex<Real>* x) {
    const Complex<Real> a = x[0], b = x[1];
    x[0] = a + b;
    x[1] = a - b;
  }
};

template <int kSign, class Real>
struct SmallFourier<4, kSign, Real> {
  static EMSCAPE_HD void run(Complex<Real>* x) {
    const Complex<Real> ac = x[0] + x[2], a_c = x[0] - x[2], bd = x[1] + x[3], b_d = x[1] - x[3];
    const Complex<Real> turned{kSign > 0 ? -b_d.im : b_d.im, kSign > 0 ? b_d.re : -b_d.re};
    x[0] = ac + bd;
    x[1] = a_c + turned;
    x[2] = ac - bd;
    x[3] = a_c - turned;
  }
};

/// a exp(kSign i pi / 4).
template <int kSign, class Real>
EMSCAPE_HD Complex<Real> eighthTurn(Complex<Real> a) {
  constexpr auto kHalfRoot = ScalarOf<Real>(0.70710678118654752440);
  return kSign > 0 ? Complex<Real>{(a.re - a.im) * kHalfRoot, (a.re + a.im) * kHalfRoot}
                   : Complex<Real>{(a.re + a.im) * kHalfRoot, (a.im - a.re) * kHalfRoot};
}
/// a exp(kSign i pi / 2).
template <int kSign, class Real>
EMSCAPE_HD Complex<Real> quarterTurn(Complex<Real> a) {
  return kSign > 0 ? Complex<Real>{-a.im, a.re} : Complex<Real>{a.im, -a.re};
}

template <int kSign, class Real>
struct SmallFourier<8, kSign, Real> {
  static EMSCAPE_HD void run(Complex<Real>* x) {
    Complex<Real> even[4] = {x[0], x[2], x[4], x[6]}, odd[4] = {x[1], x[3], x[5], x[7]};
    SmallFourier<4, kSign, Real>::run(even);
    SmallFourier<4, kSign, Real>::run(odd);
    odd[1] = eighthTurn<kSign>(odd[1]);
    odd[2] = quarterTurn<kSign>(odd[2]);
    odd[3] = quarterTurn<kSign>(eighthTurn<kSign>(odd[3]));
    EMSCAPE_UNROLL
    for (int k = 0; k < 4; ++k) {
      x[k] = even[k] + odd[k];
      x[k + 4] = even[k] - odd[k];
    }
  }
};

template <int kSign, class Real>
struct SmallFourier<16, kSign, Real> {
  static EMSCAPE_HD void run(Complex<Real>* x) {
    constexpr auto c = ScalarOf<Real>(0.92387953251128675613),
                   s = ScalarOf<Real>(0.38268343236508977173);  // of pi / 8
    constexpr Complex<ScalarOf<Real>> one{c, kSign * s}, three{s, kSign * c};
    Complex<Real> parts[4][4];  // by j mod 4
    EMSCAPE_UNROLL
    for (int b = 0; b < 4; ++b) {
      EMSCAPE_UNROLL
      for (int a = 0; a < 4; ++a) parts[b][a] = x[4 * a + b];
      SmallFourier<4, kSign, Real>::run(parts[b]);
    }
    parts[1][1] = parts[1][1] * one;
    parts[1][2] = eighthTurn<kSign>(parts[1][2]);
    parts[1][3] = parts[1][3] * three;
    parts[2][1] = eighthTurn<kSign>(parts[2][1]);
    parts[2][2] = quarterTurn<kSign>(parts[2][2]);
    parts[2][3] = quarterTurn<kSign>(eighthTurn<kSign>(parts[2][3]));
    parts[3][1] = parts[3][1] * three;
    parts[3][2] = quarterTurn<kSign>(eighthTurn<kSign>(parts[3][2]));
    parts[3][3] = Complex<Real>{} - parts[3][3] * one;  // nine sixteenths of a turn
    EMSCAPE_UNROLL
    for (int k = 0; k < 4; ++k) {
      Complex<Real> column[4] = {parts[0][k], parts[1][k], parts[2][k], parts[3][k]};
      SmallFourier<4, kSign, Real>::run(column);
      EMSCAPE_UNROLL
      for (int m = 0; m < 4; ++m) x[k + 4 * m] = column[m];
    }
  }
};
