// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "formulas/by_hand.hpp"
#include "formulas/parts.hpp"
#include "formulas/table.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/norm.hpp>

#include <Eigen/Geometry>

// N10–N16: dual numbers, dual vectors, dual quaternions.

namespace duet_formulas {
namespace {

constexpr auto number = argument::number;
constexpr auto vector = argument::vector;
constexpr auto quaternion = argument::quaternion;

template <class T>
duet::screw_dual<T> d_of(const numbers<T>& x, std::size_t i) {
  return {x[i], x[i + 1]};
}
template <class T>
duet::dual_quaternion<T> a_of(const numbers<T>& x, std::size_t i) {
  return duet::make_dual_quaternion(q_of(x, i), q_of(x, i + 4));
}

} // namespace

std::vector<formula> dual_formulas() {
  return {
      make_formula(
          "N10",
          R"((a_1+\varepsilon b_1)(a_2-\varepsilon b_2) = a_1a_2 + \varepsilon(b_1a_2 - a_1b_2))",
          "dual, dual_conj", "dual_quaternion/dual_quaternion.hpp",
          {number, number, number, number},
          []<class T>(const numbers<T>& x) {
            return all<T>(duet::screw_dual<T>(d_of(x, 0) * dual_conj(d_of(x, 2))));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            return numbers<T>{T(x[0] * x[2]), T(x[1] * x[2] - x[0] * x[3]),
                              T(d[0] * x[2] + x[0] * d[2]),
                              T(d[1] * x[2] + x[1] * d[2] - d[0] * x[3] - x[0] * d[3])};
          }),
      make_formula(
          "N11", R"(D^{-1} = \tfrac1a(1 - \varepsilon\tfrac ba))", "operator/", "dual/level.hpp",
          {number, number},
          []<class T>(const numbers<T>& x) {
            return all<T>(duet::screw_dual<T>(T(1) / d_of(x, 0)));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            const T r = 1 / x[0];
            return numbers<T>{r, T(-x[1] * r * r), T(-d[0] * r * r),
                              T((2 * x[1] * d[0] * r - d[1]) * r * r)};
          },
          {}, [](const numbers<double>& x) { return std::abs(x[0]) > 1e-100; }),
      make_formula(
          "N12", R"(x\cdot y,\; x\times y,\quad x = \vec a + \varepsilon\vec b)", "dual_vector",
          "dual_quaternion/dual_quaternion.hpp", {vector, vector, vector, vector},
          []<class T>(const numbers<T>& x) {
            const auto p = duet::make_dual_vector(v_of(x, 0), v_of(x, 3));
            const auto q = duet::make_dual_vector(v_of(x, 6), v_of(x, 9));
            return all<T>(duet::screw_dual<T>(p.dot(q)), duet::dual_vector<T>(p.cross(q)));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const auto f = [](const v3<T>& a, const v3<T>& b, const v3<T>& u, const v3<T>& v) {
              return row<T>(std::array<T, 2>{dot(a, u), T(dot(a, v) + dot(b, u))}, cross(a, u),
                            plus(cross(a, v), cross(b, u)));
            };
            const v3<T> a = part<3>(x, 0), b = part<3>(x, 3), u = part<3>(x, 6), v = part<3>(x, 9);
            numbers<T> y = f(a, b, u, v);
            const numbers<T> left = f(part<3>(d, 0), part<3>(d, 3), u, v);
            const numbers<T> right = f(a, b, part<3>(d, 6), part<3>(d, 9));
            for (std::size_t i = 0; i < left.size(); ++i) {
              y.push_back(left[i] + right[i]);
            }
            return y;
          }),
      make_formula(
          "N13", R"((D_0, \vec D) = p + \varepsilon q)", "dual_quaternion, real_part, dual_part",
          "dual_quaternion/dual_quaternion.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) {
            // Composed of four dual numbers, read as two quaternions.
            using D = duet::screw_dual<T>;
            return all<T>(duet::dual_quaternion<T>(D(x[0], x[4]), D(x[1], x[5]), D(x[2], x[6]),
                                                   D(x[3], x[7])));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) { return by_hand::row<T>(x, d); }),
      make_formula(
          "N14",
          R"((p_1+\varepsilon q_1)(p_2+\varepsilon q_2) = p_1p_2 + \varepsilon(q_1p_2 + p_1q_2))",
          "operator*", "quaternion/quaternion.hpp",
          {quaternion, quaternion, quaternion, quaternion},
          []<class T>(const numbers<T>& x) { return all<T>(a_of(x, 0) * a_of(x, 8)); },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            const q4<T> p = part<4>(x, 0), q = part<4>(x, 4), u = part<4>(x, 8), v = part<4>(x, 12);
            const q4<T> dp = part<4>(d, 0), dq = part<4>(d, 4), du = part<4>(d, 8),
                        dv = part<4>(d, 12);
            return row<T>(
                product(p, u), plus(product(q, u), product(p, v)),
                plus(product(dp, u), product(p, du)),
                plus(plus(product(dq, u), product(q, du)), plus(product(dp, v), product(p, dv))));
          }),
      make_formula(
          "N15", R"(A\,(1 + \varepsilon x)\,A^{(3)},\; A\,l\,A^{(1)},\; A^{(2)})",
          "point_conj, conj, dual_conj", "dual_quaternion/dual_quaternion.hpp",
          {quaternion, quaternion, vector},
          []<class T>(const numbers<T>& x) {
            const auto a = a_of(x, 0);
            const duet::quaternion<T> pure(T(0), v_of(x, 8));
            const auto point = duet::make_dual_quaternion(duet::quaternion<T>(T(1)), pure);
            const auto line = duet::make_dual_quaternion(pure, duet::quaternion<T>(T(0)));
            return all<T>(a * point * point_conj(a), a * line * conj(a), dual_conj(a));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            // Every product is linear in each of its three factors: A, the transformed element, A
            // again.
            const auto f = [](const q4<T>& p, const q4<T>& q, const T& one, const q4<T>& v,
                              const q4<T>& r, const q4<T>& s) {
              const q4<T> rc = conj(r), sc = conj(s);
              const q4<T> point = plus(plus(product(times(one, q), rc), product(product(p, v), rc)),
                                       times(T(-one), product(p, sc)));
              const q4<T> line = product(product(p, v), rc);
              const q4<T> moment = plus(product(product(q, v), rc), product(product(p, v), sc));
              return row<T>(times(one, product(p, rc)), point, line, moment);
            };
            const q4<T> p = part<4>(x, 0), q = part<4>(x, 4), v = pure(part<3>(x, 8));
            const q4<T> dp = part<4>(d, 0), dq = part<4>(d, 4), dv = pure(part<3>(d, 8));
            numbers<T> y = row<T>(f(p, q, T(1), v, p, q), p, times(T(-1), q));
            const numbers<T> a = f(dp, dq, T(1), v, p, q);
            const numbers<T> b = f(p, q, T(0), dv, p, q);
            const numbers<T> c = f(p, q, T(1), v, dp, dq);
            for (std::size_t i = 0; i < a.size(); ++i) {
              y.push_back(a[i] + b[i] + c[i]);
            }
            const q4<T> minus = times(T(-1), dq);
            y.insert(y.end(), dp.begin(), dp.end());
            y.insert(y.end(), minus.begin(), minus.end());
            return y;
          }),
      make_formula(
          "N16", R"(\lvert A\rvert = \lvert p\rvert + \varepsilon\,p\cdot q/\lvert p\rvert)",
          "norm, is_unit, normalized", "quaternion/norm.hpp", {quaternion, quaternion},
          []<class T>(const numbers<T>& x) {
            return all<T>(duet::screw_dual<T>(norm(a_of(x, 0))));
          },
          []<class T>(const numbers<T>& x, const numbers<T>& d) {
            using namespace by_hand;
            using std::sqrt;
            const q4<T> p = part<4>(x, 0), q = part<4>(x, 4), dp = part<4>(d, 0),
                        dq = part<4>(d, 4);
            const T size = sqrt(dot(p, p));
            const T dsize = dot(p, dp) / size;
            const T dual = dot(p, q) / size;
            return numbers<T>{size, dual, dsize,
                              T((dot(dp, q) + dot(p, dq)) / size - dual * dsize / size)};
          })};
}

} // namespace duet_formulas
