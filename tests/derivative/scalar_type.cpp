// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/derivative/scalar_type.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <Eigen/Core>

namespace test_derivative_scalar_type {
namespace {

using duet::scalar_t;

using D = duet::dual<double, 3>;

template <class X>
concept HasScalar = requires {
  typename scalar_t<X>;
};

TEST_CASE_TEMPLATE("scalar_t: the scalar of scalars and of what is made of them", T, float, double,
                   D, duet::taylor<double, 3>, duet::batch<double>) {
  CHECK(std::is_same_v<scalar_t<T>, T>);
  CHECK(std::is_same_v<scalar_t<const T&>, T>);
  CHECK(std::is_same_v<scalar_t<Eigen::Matrix<T, 3, Eigen::Dynamic>>, T>);
  CHECK(std::is_same_v<scalar_t<std::vector<std::array<T, 3>>>, T>);
  CHECK(std::is_same_v<scalar_t<duet::quaternion<T>>, T>);
  CHECK(std::is_same_v<scalar_t<std::vector<duet::dual_quaternion<T>>>, T>);
}

TEST_CASE("scalar_t: curves and chains, and types without a scalar") {
  CHECK(std::is_same_v<scalar_t<duet::cumulative_bspline<D>>, D>);
  CHECK(std::is_same_v<scalar_t<duet::rotation_vector_spline<duet::screw_dual<double>>>, double>);
  CHECK(std::is_same_v<scalar_t<decltype(duet::robots::panda())>, double>);
  CHECK(std::is_same_v<scalar_t<int>, int>);
  CHECK(!HasScalar<std::tuple<double, D>>);
  CHECK(!HasScalar<const char*>);
}

} // namespace
} // namespace test_derivative_scalar_type
