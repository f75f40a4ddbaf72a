// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "kinematics/arms.hpp"

#include <duet/duet.hpp>
#include <duet/interop/multiprecision.hpp>

namespace test_kinematics_manipulability {
namespace {

using namespace duet;
using duet_test::coordinates;
using duet_test::max_abs_difference;

/// √det(JJᵀ) by elimination.
template <class M>
auto volume_by_elimination(const M& m) {
  using S = typename M::Scalar;
  std::array<std::array<S, 6>, 6> g;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      g[i][k] = S(0);
      for (Eigen::Index j = 0; j < m.cols(); ++j) {
        g[i][k] += m(Eigen::Index(i), j) * m(Eigen::Index(k), j);
      }
    }
  }
  S product(1);
  for (std::size_t i = 0; i < 6; ++i) {
    product *= g[i][i];
    for (std::size_t k = i + 1; k < 6; ++k) {
      const S factor = g[k][i] / g[i][i];
      for (std::size_t j = i; j < 6; ++j) {
        g[k][j] -= factor * g[i][j];
      }
    }
  }
  using std::sqrt;
  return S(sqrt(product));
}

TEST_CASE("manipulability: equals √det(JJᵀ), and its gradient 50-digit dual numbers") {
  for (const auto& arm : {robots::panda().table(), robots::baxter_left().table(),
                          robots::iiwa14().table(), duet_test::every_joint()}) {
    const auto all = duet_test::configurations(arm, 10);
    for (std::size_t i = 5; i < all.size(); ++i) {
      const auto closed = manipulability_gradient(arm, all[i]);
      const Eigen::Matrix<real_50, 7, 1> exact = all[i].cast<real_50>();
      const auto by_duals = gradient(
          [&](const auto& x) { return volume_by_elimination(jacobian(arm, x, frame::spatial)); },
          exact);
      CHECK(closed.value == manipulability(arm, all[i]));
      CHECK(std::abs(closed.value - double(by_duals.value)) < 1e-14);
      CHECK(max_abs_difference(closed.gradient, by_duals.gradient.template cast<double>()) < 1e-13);
    }
  }
}

TEST_CASE("manipulability: a planar two-link arm agrees with the closed form") {
  const double a = .7, b = .4;
  const auto arm = from_dh(std::array<dh_row<>, 2>{{{.a = a}, {.a = b}}});
  const auto upper = [&](const auto& theta) { // the two coordinates of its tip only
    return jacobian(arm, theta, frame::hybrid).template topRows<2>().determinant();
  };
  for (const double bend : {1e-6, .3, -1.2, 3.1}) {
    const Eigen::Vector2d theta(.4, bend);
    CHECK(upper(theta) == doctest::Approx(a * b * std::sin(bend)).epsilon(1e-12));
    // With the angular rows: det JᵀJ = (|u₁|² + 1)(|u₂|² + 1) − (u₁·u₂ + 1)².
    const auto [w, gradient] = derivative(
        [&](const auto& x) {
          const auto u1 = a * a + b * b + 2 * a * b * cos(x) + 1;
          const auto both = b * (a * cos(x) + b) + 1;
          return sqrt(u1 * (b * b + 1) - both * both);
        },
        bend);
    const auto closed = manipulability_gradient(arm, theta);
    CHECK(closed.value == doctest::Approx(w).epsilon(1e-12));
    CHECK(max_abs_difference(closed.gradient, Eigen::Vector2d(0, gradient)) < 1e-13);
  }
}

TEST_CASE("manipulability: vanishes linearly at singularities, where the gradient is rejected") {
  const auto arm = robots::iiwa14().table();
  coordinates<7> theta = coordinates<7>::Zero(); // stretched
  CHECK(manipulability(arm, theta) < 1e-16);
  // Near the singularity of the elbow alone w is linear, without loss of digits.
  theta << .3, -1, 1.5, 1e-9, .4, .9, .7;
  const double w = manipulability(arm, theta);
  theta[3] = 2e-9;
  CHECK(manipulability(arm, theta) == doctest::Approx(2 * w).epsilon(1e-6));
  CHECK(w > 1e-12);

  // Two coincident axes, exactly.
  const std::array<joint<>, 2> joints{};
  const serial_chain<2> twice(joints);
  const Eigen::Vector2d zero(0, 0);
  CHECK(manipulability(twice, zero) == 0);
  CHECK_THROWS_AS((void)manipulability_gradient(twice, zero), invalid_input);
}

TEST_CASE("manipulability_gradient: accurate within round-off of a singularity") {
  const auto arm = robots::ur5e().table();
  coordinates<6> theta;
  theta << .3, -1, 1e-6, -.7, .9, .7; // the elbow is nearly stretched
  const double gradient = manipulability_gradient(arm, theta).gradient[2];
  CHECK(gradient > .05);
  int regular = 0;
  for (const double bend : {1e-14, 1e-15, 7e-16, 4e-16, 1e-16, 5e-17, 1e-17, 1e-100}) {
    CAPTURE(bend);
    theta[2] = bend;
    if (manipulability(arm, theta) > 0) { // rounded to either side
      ++regular;
      coordinates<6> g = manipulability_gradient(arm, theta).gradient;
      CHECK(std::abs(g[2]) == doctest::Approx(gradient).epsilon(1e-6));
      g[2] = 0;
      CHECK(g.norm() < 1e-13);
    }
  }
  CHECK(regular > 3);

  // |det M| M⁻ᵀ is, except for its sign, the matrix of cofactors, for any smallest pivot.
  for (const double small : {1e-3, 1e-16, -1e-17, 1e-140}) {
    detail::tall_matrix<double, 2> m(2, 2), cofactors(2, 2);
    m << 1, 2, 0, small;
    cofactors << small, 0, -2, 1;
    const auto [volume, of_entries] = detail::volume_of<true>(m);
    CHECK(std::abs(volume - std::abs(small)) <= 1e-15 * std::abs(small));
    cofactors *= small > 0 ? 1 : -1;
    CHECK(max_abs_difference(of_entries, cofactors) < 1e-15);
  }
}

TEST_CASE("manipulability: a bounded_chain equals the serial_chain of the same joints") {
  const auto panda = robots::panda().table();
  const bounded_chain<9> chain = panda;
  for (const auto& theta : duet_test::configurations(panda, 3)) {
    const Eigen::VectorXd x = theta;
    CHECK(manipulability(chain, x) == doctest::Approx(manipulability(panda, theta)).epsilon(1e-10));
  }
  coordinates<7> regular;
  regular << .3, -1, 1.5, -1.2, .4, .9, .7;
  const Eigen::VectorXd x = regular;
  CHECK(max_abs_difference(manipulability_gradient(chain, x).gradient,
                           manipulability_gradient(panda, regular).gradient) < 1e-14);
  const bounded_chain<9> rigid(std::span<const joint<>>{});
  CHECK(manipulability(rigid, Eigen::VectorXd(0)) == 1);
  CHECK(manipulability_gradient(rigid, Eigen::VectorXd(0)).gradient.size() == 0);
}

} // namespace
} // namespace test_kinematics_manipulability
