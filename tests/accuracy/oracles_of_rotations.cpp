// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/oracles.hpp"

namespace duet_test::accuracy::oracle {

namespace {

jet_quaternion rotation_at(const jets& x, std::size_t first = 0) {
  return {x[first], x[first + 1], x[first + 2], x[first + 3]};
}
jet_quaternion vector_at(const jets& x, std::size_t first = 0, const jet& factor = 1) {
  return {jet(0), x[first] * factor, x[first + 1] * factor, x[first + 2] * factor};
}
jets list_of(const jet_quaternion& q) { return {q[0], q[1], q[2], q[3]}; }
jets vector_of(const jet_quaternion& q, const jet& factor) {
  return {q[1] * factor, q[2] * factor, q[3] * factor};
}
jet length_of(const jet_quaternion& q) { return sqrt(squared_norm(q)); }

/// The matrix of v ↦ q v q*, in columns.
jets matrix_of(const jet_quaternion& q) {
  jets result;
  for (std::size_t j = 1; j < 4; ++j) {
    jet_quaternion e{0, 0, 0, 0};
    e[j] = jet(1);
    const jet_quaternion image = q * e * conj(q);
    result.insert(result.end(), image.begin() + 1, image.end());
  }
  return result;
}

} // namespace

jets vector_exp(const jets& x) { return list_of(exp(vector_at(x))); }
jets log(const jets& x) { return list_of(accuracy::log(rotation_at(x))); }
jets pow(const jets& x) { return list_of(exp(accuracy::log(rotation_at(x)) * x[4])); }
jets slerp(const jets& x) {
  return list_of(accuracy::slerp(rotation_at(x), rotation_at(x, 4), x[8]));
}
jets rotation_vector(const jets& x) {
  const int sign = x[0].c[0] < 0 ? -1 : 1;
  return vector_of(accuracy::log(rotation_at(x) * jet(sign)), 2);
}
jets from_axis_angle(const jets& x) {
  const jet_quaternion axis = vector_at(x);
  const jet half = x[3] * jet(real(1) / 2);
  jet_quaternion q = axis * (sin(half) / length_of(axis));
  q[0] = cos(half);
  return list_of(q);
}
/// |a||b| + a·b + a × b, normalised: b a* has the scalar part a·b and the vector part a × b.
jets from_two_vectors(const jets& x) {
  const jet_quaternion a = vector_at(x), b = vector_at(x, 3);
  jet_quaternion q = b * conj(a);
  q[0] = q[0] + length_of(a) * length_of(b);
  return list_of(q * (jet(1) / length_of(q)));
}
jets rotate(const jets& x) {
  const jet_quaternion q = exp(vector_at(x));
  return vector_of(q * vector_at(x, 3) * conj(q), 1);
}
jets rotation_matrix(const jets& x) { return matrix_of(exp(vector_at(x))); }

/// Column j: ω = 2 (∂q/∂u) q* of q = exp(½(x + u e_j)) at u = 0.
jets jacobian(const jets& x) {
  jets result;
  for (std::size_t j = 0; j < 3; ++j) {
    jets moved = x;
    moved[j] = moved[j] + u_variable();
    const jet_quaternion q = exp(vector_at(moved, 0, jet(real(1) / 2)));
    jet_quaternion slope;
    for (std::size_t i = 0; i < 4; ++i) {
      slope[i] = coefficient_of_u(q[i]);
    }
    const jets column = vector_of(slope * conj(q), 2);
    result.insert(result.end(), column.begin(), column.end());
  }
  return result;
}
jets jacobian_inverse(const jets& x) { return inverse_of_three(jacobian(x)); }

jets spatial_velocity(const jets& x) {
  return vector_of(rotation_at(x, 4) * conj(rotation_at(x)), 2);
}
jets body_velocity(const jets& x) { return vector_of(conj(rotation_at(x)) * rotation_at(x, 4), 2); }

/// Euler angles by the entries of R = R_i(a) R_j(b) R_k(c) with at most two factors.
jets euler(const jets& x, const std::array<std::size_t, 3>& axes) {
  const jets m = matrix_of(rotation_at(x)); // in columns, times |q|²
  const auto [i, j, k] = axes;
  const std::size_t other = 3 - i - j;
  const jet sign(j == (i + 1) % 3 ? 1 : -1);
  const auto r = [&](std::size_t row, std::size_t column) -> const jet& {
    return m[3 * column + row];
  };
  const auto length = [](const jet& a, const jet& b) { return sqrt(a * a + b * b); };
  if (i == k) {
    return {atan2(r(j, i), -sign * r(other, i)), atan2(length(r(j, i), r(other, i)), r(i, i)),
            atan2(r(i, j), sign * r(i, other))};
  }
  return {atan2(-sign * r(j, k), r(k, k)), atan2(sign * r(i, k), length(r(i, i), r(i, j))),
          atan2(-sign * r(i, j), r(i, i))};
}
jets euler_rate_zyx(const jets& x) {
  const jet ca = cos(x[0]), sa = sin(x[0]), cb = cos(x[1]), sb = sin(x[1]);
  return {0, 0, 1, -sa, ca, 0, ca * cb, sa * cb, -sb};
}

} // namespace duet_test::accuracy::oracle
