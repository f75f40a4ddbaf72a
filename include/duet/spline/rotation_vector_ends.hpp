// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/rotation.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/half_rate.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

/// \file
/// What each end condition asks of a rotation-vector spline.

namespace duet {

/// Given angular velocities and accelerations, or twists and their derivatives: all that the
/// quintic's ends can be told. (Of only one of them, the fifth derivative's continuity at the
/// second knot takes the other's place.)
template <class V = Eigen::Matrix<double, 3, 1>>
struct fully_clamped {
  clamped<V> velocity;
  end_acceleration<V> acceleration;

  /// \throws invalid_input for a rate that is not finite
  void check() const {
    velocity.check();
    acceleration.check();
  }
};

template <class V, class W>
fully_clamped(clamped<V>, end_acceleration<W>) -> fully_clamped<V>;

namespace detail {

/// One vector equation at an end: the derivative of w with this number has a given value (joint 0),
/// or is the same on both sides of the joint-th inner knot, counted from the end.
struct end_equation {
  std::size_t joint, derivative;
};

/// What an end condition asks of a rotation-vector spline of order k: k/2 − 1 equations at each
/// end, the same at both but for the values given; nothing of a periodic one. The last derivative
/// of w that the pieces have is the (k−2)-th.
template <class T, int Order>
struct rotation_vector_ends {
  static constexpr std::size_t own = std::size_t(Order) / 2 - 1;
  static constexpr std::size_t highest = std::size_t(Order) - 2;

  bool is_cyclic = false;
  std::array<end_equation, own> equations{};
  /// Values of the equations with joint 0: halved rates in body axes, at the start and at the end.
  std::array<std::array<vector3<T>, own>, 2> given;

  rotation_vector_ends(const natural&, const quaternion<T>&, const quaternion<T>&)
      : rotation_vector_ends() {
    equations[0] = {0, 1};
    if constexpr (Order == 6) {
      // No snap either: reflected in its end, the curve goes on smoothly.
      equations[1] = {0, 3};
    }
  }
  template <class V>
  rotation_vector_ends(const clamped<V>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : rotation_vector_ends() {
    give(0, 0, ends, first, last);
    if constexpr (Order == 6) {
      equations[1] = {1, highest};
    }
  }
  template <class V>
  rotation_vector_ends(const end_acceleration<V>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : rotation_vector_ends() {
    give(0, 1, ends, first, last);
    if constexpr (Order == 6) {
      equations[1] = {1, highest};
    }
  }
  template <class V>
  rotation_vector_ends(const fully_clamped<V>& ends, const quaternion<T>& first,
                       const quaternion<T>& last)
      : rotation_vector_ends() {
    static_assert(Order == 6, "duet: the cubic's ends take velocities or accelerations, not both");
    give(0, 0, ends.velocity, first, last);
    give(1, 1, ends.acceleration, first, last);
  }
  rotation_vector_ends(const not_a_knot&, const quaternion<T>&, const quaternion<T>&)
      : rotation_vector_ends() {
    for (std::size_t k = 0; k < own; ++k) {
      equations[k] = {k + 1, highest};
    }
  }
  rotation_vector_ends(const periodic&, const quaternion<T>&, const quaternion<T>&)
      : rotation_vector_ends() {
    is_cyclic = true;
  }

  /// The highest joint: equations reach one knot further.
  [[nodiscard]] std::size_t reach() const {
    std::size_t result = 0;
    for (const end_equation& e : equations) {
      result = std::max(result, e.joint);
    }
    return result;
  }
  /// Fewer rows leave an equation without its knots, or make it the same as another.
  template <class Ends>
  [[nodiscard]] static std::size_t least_rows(const Ends& ends) {
    const rotation_vector_ends any(ends, quaternion<T>(T(1)), quaternion<T>(T(1)));
    return any.is_cyclic ? 3 : 2 + 2 * any.reach();
  }

  [[nodiscard]] rotation_vector_ends<real_type_t<T>, Order> real_part() const {
    rotation_vector_ends<real_type_t<T>, Order> result;
    result.is_cyclic = is_cyclic;
    result.equations = equations;
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t k = 0; k < own; ++k) {
        for (int a = 0; a < 3; ++a) {
          result.given[end][k][a] = innermost(given[end][k][a]);
        }
      }
    }
    return result;
  }

  /// Nothing given.
  rotation_vector_ends() {
    for (auto& end : given) {
      end.fill(vector3<T>::Constant(T(real_type_t<T>(0))));
    }
  }

private:
  /// Equation k: that derivative of w is half of what is given in spatial axes.
  template <class Rates>
  void give(std::size_t k, std::size_t derivative, const Rates& rates, const quaternion<T>& first,
            const quaternion<T>& last) {
    equations[k] = {0, derivative};
    given[0][k] = rotate(conj(first), half_rate<T>(rates.start));
    given[1][k] = rotate(conj(last), half_rate<T>(rates.end));
  }
};

} // namespace detail
} // namespace duet
