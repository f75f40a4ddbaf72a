// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/dual/eigen_solvers.hpp>

#include <Eigen/Core>

/// \file
/// Functions of Eigen that lose derivatives over dual and Taylor numbers, because they branch on
/// values or stop when values have converged. They are rejected at compile time with the function
/// to call instead.
///
/// Member functions of Eigen's quaternions and matrices cannot be replaced from outside: the page
/// "With Eigen" lists those.

namespace duet::detail {

/// An expression of Eigen over dual or Taylor numbers, or over complex numbers of those.
template <class Expression>
concept OverInfinitesimal = Infinitesimal<
    typename Eigen::NumTraits<typename Eigen::internal::traits<Expression>::Scalar>::Real>;

/// False, but not before a template is instantiated.
template <class>
inline constexpr bool never = false;

} // namespace duet::detail

#define DUET_REFUSES_SOLVER(solver, instead)                                                       \
  template <class M>                                                                               \
  class solver;                                                                                    \
  template <class M>                                                                               \
    requires duet::detail::OverInfinitesimal<M>                                                    \
  class solver<M> {                                                                                \
  public:                                                                                          \
    template <class... X>                                                                          \
    DUET_REFUSED("Eigen's " #solver " loses derivatives over dual numbers: " instead)              \
    explicit solver(const X&...);                                                                  \
  };

#define DUET_REFUSES_SVD(solver)                                                                   \
public:                                                                                            \
  template <class... X>                                                                            \
  DUET_REFUSED("Eigen's " #solver                                                                  \
               " loses derivatives over dual numbers: svd(A) or singular_values(A); for a "        \
               "Transform's rotation nearest_rotation(A), for FromTwoVectors "                     \
               "from_two_vectors(a, b)")                                                           \
  explicit solver(const X&...)

#define DUET_REFUSES_MATRIX_FUNCTION(keyword, result, function, instead)                           \
  template <class M>                                                                               \
    requires duet::detail::OverInfinitesimal<M> keyword result<M> {                                \
      static_assert(duet::detail::never<M>,                                                        \
                    "duet: Eigen's " function                                                      \
                    " of a matrix loses derivatives over dual numbers: " instead);                 \
    };

namespace Eigen {

DUET_REFUSES_SOLVER(SelfAdjointEigenSolver,
                    "symmetric_eigen(A); for operatorNorm singular_values(A)[0]")
DUET_REFUSES_SOLVER(GeneralizedSelfAdjointEigenSolver,
                    "symmetric_eigen(C) with C = L^-1 A L^-T and B = L L^T")
DUET_REFUSES_SOLVER(Tridiagonalization, "symmetric_eigen(A)")
DUET_REFUSES_SOLVER(EigenSolver, "symmetric_eigen(A), or implicit_solution of A v = lambda v")
DUET_REFUSES_SOLVER(ComplexEigenSolver, "implicit_solution of A v = lambda v")
DUET_REFUSES_SOLVER(GeneralizedEigenSolver, "implicit_solution of A v = lambda B v")
DUET_REFUSES_SOLVER(RealSchur, "implicit_solution of A v = lambda v")
DUET_REFUSES_SOLVER(ComplexSchur, "implicit_solution of A v = lambda v")
DUET_REFUSES_SOLVER(RealQZ, "implicit_solution of A v = lambda B v")
DUET_REFUSES_SOLVER(ComplexQZ, "implicit_solution of A v = lambda B v")
DUET_REFUSES_SOLVER(HessenbergDecomposition, "implicit_solution of A v = lambda v")

template <class M, int Options>
  requires duet::detail::OverInfinitesimal<M>
class JacobiSVD<M, Options> {
  DUET_REFUSES_SVD(JacobiSVD);
};
#if EIGEN_MAJOR_VERSION >= 5
template <class M, int Options>
  requires duet::detail::OverInfinitesimal<M>
class BDCSVD<M, Options> {
#else
template <class M>
  requires duet::detail::OverInfinitesimal<M>
class BDCSVD<M> {
#endif
  DUET_REFUSES_SVD(BDCSVD);
};

DUET_REFUSES_MATRIX_FUNCTION(struct, MatrixExponentialReturnValue, "exp", "matrix_exponential(A)")
DUET_REFUSES_MATRIX_FUNCTION(class, MatrixFunctionReturnValue, "sin, cos, sinh or cosh",
                             "they are sums of matrix_exponential")
DUET_REFUSES_MATRIX_FUNCTION(class, MatrixSquareRootReturnValue, "sqrt",
                             "implicit_solution of X X = A")
DUET_REFUSES_MATRIX_FUNCTION(class, MatrixLogarithmReturnValue, "log",
                             "implicit_solution of matrix_exponential(X) = A")
DUET_REFUSES_MATRIX_FUNCTION(class, MatrixPowerReturnValue, "pow",
                             "matrix_exponential(p * X) with matrix_exponential(X) = A")
DUET_REFUSES_MATRIX_FUNCTION(class, MatrixComplexPowerReturnValue, "pow",
                             "matrix_exponential(p * X) with matrix_exponential(X) = A")

template <class P, class Q>
  requires(duet::detail::OverInfinitesimal<P> || duet::detail::OverInfinitesimal<Q>)
DUET_REFUSED("Eigen's umeyama loses derivatives over dual numbers: register_points(p, q) or "
             "register_points_with_scale(p, q)")
Matrix<typename internal::traits<P>::Scalar, Dynamic, Dynamic>
umeyama(const MatrixBase<P>&, const MatrixBase<Q>&, bool = true);

/// As Eigen's own, except that conversion from a quaternion or matrix is rejected: its axis and
/// angle have no derivatives at the identity and jump at a half turn.
template <class D>
  requires duet::Infinitesimal<D>
class AngleAxis<D> : public RotationBase<AngleAxis<D>, 3> {
public:
  using Base = RotationBase<AngleAxis<D>, 3>;
  using Scalar = D;
  using Matrix3 = Matrix<D, 3, 3>;
  using Vector3 = Matrix<D, 3, 1>;
  using QuaternionType = Quaternion<D>;
  static constexpr int Dim = 3;

  AngleAxis() = default;
  template <class Axis>
  AngleAxis(const D& angle, const MatrixBase<Axis>& axis) : axis_(axis), angle_(angle) {}
  template <class Other>
  explicit AngleAxis(const AngleAxis<Other>& other)
      : axis_(other.axis().template cast<D>()), angle_(other.angle()) {}

#define DUET_REFUSES_AXIS                                                                          \
  DUET_REFUSED("the axis and angle of a rotation lose derivatives at the identity: "               \
               "rotation_vector(from_eigen(q)) or rotation_vector(from_rotation_matrix(R))")
  template <class Q>
  DUET_REFUSES_AXIS explicit AngleAxis(const QuaternionBase<Q>&);
  template <class R>
  DUET_REFUSES_AXIS explicit AngleAxis(const MatrixBase<R>&);
  template <class Q>
  DUET_REFUSES_AXIS AngleAxis& operator=(const QuaternionBase<Q>&);
  template <class R>
  DUET_REFUSES_AXIS AngleAxis& operator=(const MatrixBase<R>&);
  template <class R>
  DUET_REFUSES_AXIS AngleAxis& fromRotationMatrix(const MatrixBase<R>&);
#undef DUET_REFUSES_AXIS

  D angle() const { return angle_; }
  D& angle() { return angle_; }
  const Vector3& axis() const { return axis_; }
  Vector3& axis() { return axis_; }

  using Base::operator*;
  QuaternionType operator*(const AngleAxis& other) const {
    return QuaternionType(*this) * QuaternionType(other);
  }
  QuaternionType operator*(const QuaternionType& other) const {
    return QuaternionType(*this) * other;
  }
  friend QuaternionType operator*(const QuaternionType& a, const AngleAxis& b) {
    return a * QuaternionType(b);
  }

  AngleAxis inverse() const { return AngleAxis(D(-angle_), axis_); }
  Matrix3 toRotationMatrix() const {
    const Vector3 sine = sin(angle_) * axis_;
    const D cosine = cos(angle_);
    const Vector3 rest = (D(1) - cosine) * axis_;
    Matrix3 r;
    for (int i = 0; i < 3; ++i) {
      r(i, i) = rest[i] * axis_[i] + cosine;
      for (int j = i + 1; j < 3; ++j) {
        const D symmetric = rest[i] * axis_[j];
        const D skew = j == i + 1 ? D(-sine[3 - i - j]) : sine[3 - i - j];
        r(i, j) = symmetric + skew;
        r(j, i) = symmetric - skew;
      }
    }
    return r;
  }
  template <class Other>
  AngleAxis<Other> cast() const {
    return AngleAxis<Other>(static_cast<Other>(angle_), axis_.template cast<Other>());
  }
  static AngleAxis Identity() { return AngleAxis(D(0), Vector3::UnitX()); }
  bool isApprox(const AngleAxis& other,
                const D& precision = NumTraits<D>::dummy_precision()) const {
    return axis_.isApprox(other.axis_, precision) &&
           internal::isApprox(angle_, other.angle_, precision);
  }

private:
  Vector3 axis_;
  D angle_;
};

} // namespace Eigen

#undef DUET_REFUSES_SOLVER
#undef DUET_REFUSES_SVD
#undef DUET_REFUSES_MATRIX_FUNCTION
