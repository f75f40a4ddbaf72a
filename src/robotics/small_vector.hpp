// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Vectors of a few doubles and symmetric systems of a few equations. Eigen's expressions and
/// factorisations take the compiler longer than all the rest of a planner.

namespace duet::detail {
DUET_ABI_BEGIN

template <int N>
struct small_vector {
  std::array<double, std::size_t(N)> values{};

  [[nodiscard]] static constexpr std::ptrdiff_t size() { return N; }
  [[nodiscard]] double operator[](std::ptrdiff_t i) const { return values[std::size_t(i)]; }
  [[nodiscard]] double& operator[](std::ptrdiff_t i) { return values[std::size_t(i)]; }

  [[nodiscard]] friend small_vector operator+(small_vector a, const small_vector& b) {
    for (std::size_t i = 0; i < std::size_t(N); ++i) {
      a.values[i] += b.values[i];
    }
    return a;
  }
  [[nodiscard]] friend small_vector operator-(small_vector a, const small_vector& b) {
    for (std::size_t i = 0; i < std::size_t(N); ++i) {
      a.values[i] -= b.values[i];
    }
    return a;
  }
  [[nodiscard]] friend small_vector operator*(double s, small_vector a) {
    for (double& x : a.values) {
      x *= s;
    }
    return a;
  }
  [[nodiscard]] friend double dot(const small_vector& a, const small_vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < std::size_t(N); ++i) {
      sum += a.values[i] * b.values[i];
    }
    return sum;
  }
  [[nodiscard]] friend double norm(const small_vector& a) { return std::sqrt(dot(a, a)); }
};

/// Matrix of `Rows` rows and up to `Capacity` columns.
template <int Rows, int Capacity>
struct small_matrix {
  using Scalar = double;

  std::array<small_vector<Rows>, std::size_t(Capacity)> columns{};
  std::ptrdiff_t count = Capacity; ///< number of columns

  void resize(std::ptrdiff_t, std::ptrdiff_t n) { count = n; }
  [[nodiscard]] static constexpr std::ptrdiff_t rows() { return Rows; }
  [[nodiscard]] std::ptrdiff_t cols() const { return count; }
  [[nodiscard]] double operator()(std::ptrdiff_t i, std::ptrdiff_t j) const {
    return columns[std::size_t(j)][i];
  }
  [[nodiscard]] double& operator()(std::ptrdiff_t i, std::ptrdiff_t j) {
    return columns[std::size_t(j)][i];
  }
};

/// Cholesky factors L Lᵀ of a symmetric positive semidefinite matrix. An unknown whose pivot is not
/// positive is left out: it is 0 in solutions.
template <class M>
class cholesky {
public:
  /// \param a  matrix, of which the lower half is used
  explicit cholesky(const M& a) : l_(a) {
    for (std::ptrdiff_t j = 0; j < l_.rows(); ++j) {
      for (std::ptrdiff_t i = j; i < l_.rows(); ++i) {
        double rest = l_(i, j);
        for (std::ptrdiff_t k = 0; k < j; ++k) {
          rest -= l_(i, k) * l_(j, k);
        }
        if (i > j) {
          l_(i, j) = rest * l_(j, j);
        } else {
          l_(i, i) = rest > 0 ? 1 / std::sqrt(rest) : 0;
          is_positive_ = is_positive_ && rest > 0;
        }
      }
    }
  }

  [[nodiscard]] bool is_positive() const { return is_positive_; }

  /// Solves L Lᵀ x = b.
  template <class V>
  [[nodiscard]] V solve(const V& b) const {
    return backward(forward(b));
  }
  /// Solves L x = b.
  template <class V>
  [[nodiscard]] V forward(V x) const {
    const std::ptrdiff_t n = l_.rows();
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      for (std::ptrdiff_t k = 0; k < i; ++k) {
        x[i] -= l_(i, k) * x[k];
      }
      x[i] *= l_(i, i);
    }
    return x;
  }
  /// Solves Lᵀ x = b.
  template <class V>
  [[nodiscard]] V backward(V x) const {
    const std::ptrdiff_t n = l_.rows();
    for (std::ptrdiff_t i = n; i-- > 0;) {
      for (std::ptrdiff_t k = i + 1; k < n; ++k) {
        x[i] -= l_(k, i) * x[k];
      }
      x[i] *= l_(i, i);
    }
    return x;
  }

private:
  M l_;
  bool is_positive_ = true;
};

DUET_ABI_END
} // namespace duet::detail
