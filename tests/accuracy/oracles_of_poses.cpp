// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "accuracy/oracles.hpp"

namespace duet_test::accuracy::oracle {

namespace {

jet_quaternion pose_at(const jets& x, std::size_t first = 0) {
  jet_quaternion q;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = with_epsilon(x[first + i], x[first + i + 4]);
  }
  return q;
}
jets list_of(const jet_quaternion& a) {
  jets result;
  for (const jet& c : a) {
    result.push_back(without_epsilon(c));
  }
  for (const jet& c : a) {
    result.push_back(epsilon_part(c));
  }
  return result;
}
/// The pure dual quaternion a⃗ + εb⃗ with a⃗ and b⃗ at these indices, times a factor.
jet_quaternion vector_at(const jets& x, std::size_t a, std::size_t b, const jet& factor = 1) {
  return {jet(0), with_epsilon(x[a], x[b]) * factor, with_epsilon(x[a + 1], x[b + 1]) * factor,
          with_epsilon(x[a + 2], x[b + 2]) * factor};
}
jet_quaternion dual_conj(const jet_quaternion& a) {
  jet_quaternion r;
  for (std::size_t i = 0; i < 4; ++i) {
    r[i] = with_epsilon(without_epsilon(a[i]), -epsilon_part(a[i]));
  }
  return r;
}
/// 2 vec of a dual quaternion as [v; ω].
jets twist_of(const jet_quaternion& a) {
  jets result;
  for (std::size_t i = 1; i < 4; ++i) {
    result.push_back(jet(2) * epsilon_part(a[i]));
  }
  for (std::size_t i = 1; i < 4; ++i) {
    result.push_back(jet(2) * without_epsilon(a[i]));
  }
  return result;
}
/// A 3 × 3 matrix A + εB, in columns, as the blocks A, B, A.
jets blocks_of(const jets& m) {
  jets result;
  for (int block = 0; block < 3; ++block) {
    for (const jet& c : m) {
      result.push_back(block == 1 ? epsilon_part(c) : without_epsilon(c));
    }
  }
  return result;
}

/// Column j: ω = 2 (∂A/∂u) A* of A = exp(½(x + u e_j)) at u = 0, x a dual vector.
jets dual_jacobian(const jets& x) {
  jets result;
  for (std::size_t j = 1; j < 4; ++j) {
    jet_quaternion v = vector_at(x, 3, 0, jet(real(1) / 2));
    v[j] = v[j] + u_variable() * jet(real(1) / 2);
    const jet_quaternion a = exp(v);
    jet_quaternion slope;
    for (std::size_t i = 0; i < 4; ++i) {
      slope[i] = coefficient_of_u(a[i]);
    }
    const jet_quaternion omega = slope * conj(a);
    for (std::size_t i = 1; i < 4; ++i) {
      result.push_back(jet(2) * omega[i]);
    }
  }
  return result;
}

} // namespace

jets inverse_of_three(const jets& m) {
  // Cofactors over the determinant.
  const auto at = [&](std::size_t i, std::size_t j) -> const jet& {
    return m[3 * (j % 3) + i % 3];
  };
  const auto cofactor = [&](std::size_t i, std::size_t j) {
    return at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1);
  };
  const jet reciprocal =
      jet(1) / (at(0, 0) * cofactor(0, 0) + at(0, 1) * cofactor(0, 1) + at(0, 2) * cofactor(0, 2));
  jets result;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      result.push_back(cofactor(j, i) * reciprocal);
    }
  }
  return result;
}

jets dual_exp(const jets& x) { return list_of(exp(vector_at(x, 0, 3))); }
jets dual_log(const jets& x) { return list_of(log(pose_at(x))); }
jets dual_pow(const jets& x) { return list_of(exp(log(pose_at(x)) * x[8])); }
jets sclerp(const jets& x) { return list_of(slerp(pose_at(x), pose_at(x, 8), x[16])); }

jets screw_parameters(const jets& x) {
  jet_quaternion a = pose_at(x);
  if (a[0].c[0] < 0) {
    a = a * jet(-1);
  }
  const jet_quaternion half = log(a); // ½ (φ + εd)(n + εm)
  const jet length = sqrt(half[1] * half[1] + half[2] * half[2] + half[3] * half[3]);
  jets result;
  for (std::size_t i = 1; i < 4; ++i) {
    result.push_back(without_epsilon(half[i] / length));
  }
  for (std::size_t i = 1; i < 4; ++i) {
    result.push_back(epsilon_part(half[i] / length));
  }
  result.push_back(jet(2) * without_epsilon(length));
  result.push_back(jet(2) * epsilon_part(length));
  return result;
}
jets from_screw(const jets& x) {
  return list_of(exp(vector_at(x, 0, 3) * (with_epsilon(x[6], x[7]) * jet(real(1) / 2))));
}

jets translation(const jets& x) {
  const jet_quaternion a = pose_at(x);
  jet_quaternion p, q;
  for (std::size_t i = 0; i < 4; ++i) {
    p[i] = without_epsilon(a[i]);
    q[i] = epsilon_part(a[i]);
  }
  const jet_quaternion t = q * conj(p);
  jets result;
  for (std::size_t i = 1; i < 4; ++i) {
    result.push_back(jet(2) * t[i]);
  }
  return result;
}

/// A (1 + εx) A°* by the third conjugate.
jets transform_point(const jets& x) {
  const jet_quaternion a = exp(vector_at(x, 0, 3));
  const jet_quaternion point{jet(1), with_epsilon(0, x[6]), with_epsilon(0, x[7]),
                             with_epsilon(0, x[8])};
  const jet_quaternion image = a * point * conj(dual_conj(a));
  return {epsilon_part(image[1]), epsilon_part(image[2]), epsilon_part(image[3])};
}

/// Matrix with the columns A e_j A*.
jets adjoint(const jets& x) {
  const jet_quaternion a = exp(vector_at(x, 0, 3));
  jets columns;
  for (std::size_t j = 1; j < 4; ++j) {
    jet_quaternion e{0, 0, 0, 0};
    e[j] = jet(1);
    const jet_quaternion image = a * e * conj(a);
    columns.insert(columns.end(), image.begin() + 1, image.end());
  }
  return blocks_of(columns);
}

jets spatial_twist(const jets& x) { return twist_of(pose_at(x, 8) * conj(pose_at(x))); }
jets body_twist(const jets& x) { return twist_of(conj(pose_at(x)) * pose_at(x, 8)); }

jets pose_jacobian(const jets& x) { return blocks_of(dual_jacobian(x)); }
jets pose_jacobian_inverse(const jets& x) { return blocks_of(inverse_of_three(dual_jacobian(x))); }

} // namespace duet_test::accuracy::oracle
