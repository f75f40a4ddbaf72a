// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/taylor.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Matrices of Eigen as containers of scalars; batches, dual and Taylor numbers as scalars of
/// Eigen, in mixed expressions with double too. Solvers that keep derivatives at zeros; errors for
/// functions that lose them.

namespace Eigen {

template <class T, int W>
struct NumTraits<duet::batch<T, W>> : NumTraits<T> {
  using number = duet::batch<T, W>;
  using Real = number;
  using NonInteger = number;
  using Nested = number;
  using Literal = T;
  // Copied by type: g++ warns of Eigen's memcpy, as a batch assigns itself.
  static constexpr int RequireInitialization = 1;
};

template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<duet::batch<T, W>, T, Operation> {
  using ReturnType = duet::batch<T, W>;
};
template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<T, duet::batch<T, W>, Operation> {
  using ReturnType = duet::batch<T, W>;
};

} // namespace Eigen

namespace duet {
namespace detail {

template <class Derived>
void take_matrix(const Eigen::MatrixBase<Derived>&);

/// A matrix or vector of Eigen, or an expression of them, including blocks of vectors, which are
/// not derived from the `MatrixBase` of their own type.
template <class M>
concept EigenMatrix = requires(const M& m) {
  take_matrix(m);
};

/// A matrix of the size and layout of M over another scalar.
template <class M, class S>
using matrix_over =
    Eigen::Matrix<S, M::RowsAtCompileTime, M::ColsAtCompileTime, M::PlainObject::Options,
                  M::MaxRowsAtCompileTime, M::MaxColsAtCompileTime>;

} // namespace detail

/// Visits the scalars of a matrix column by column.
template <class M>
  requires detail::EigenMatrix<M>
struct structure<M> {
  using scalar = typename M::Scalar;
  template <class F, class... Rest>
  [[nodiscard]] static auto map(F&& f, const M& m, const Rest&... rest) {
    using result = std::decay_t<decltype(f(m(0, 0), rest(0, 0)...))>;
    detail::matrix_over<M, result> y(m.rows(), m.cols());
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      for (Eigen::Index i = 0; i < m.rows(); ++i) {
        y(i, j) = f(m(i, j), rest(i, j)...);
      }
    }
    return y;
  }
};

} // namespace duet

namespace duet::detail {

template <class Lhs, class Rhs>
concept MixedFactors = (Infinitesimal<Lhs> || Infinitesimal<Rhs>)&&!std::same_as<Lhs, Rhs>;

/// An architecture that no processor has, to reach Eigen's generic kernel from its specialisation.
inline constexpr int no_architecture = -1;

} // namespace duet::detail

namespace Eigen::internal {

/// Eigen's kernel stores each product a·b in a variable of b's type before it is added, which does
/// not compile if b is the narrower of the two.
template <class Lhs, class Rhs, bool ConjLhs, bool ConjRhs, int Arch, int PacketSize>
  requires(duet::detail::MixedFactors<Lhs, Rhs>&& Arch != duet::detail::no_architecture)
class gebp_traits<Lhs, Rhs, ConjLhs, ConjRhs, Arch, PacketSize>
    : public gebp_traits<Lhs, Rhs, ConjLhs, ConjRhs, duet::detail::no_architecture, PacketSize> {
  using base = gebp_traits<Lhs, Rhs, ConjLhs, ConjRhs, duet::detail::no_architecture, PacketSize>;

public:
  template <class Sum, class Lane>
  void madd(const Lhs& a, const Rhs& b, Sum& c, Rhs&, const Lane&) const {
    c += a * b;
  }
  template <class Sum, class Lane>
  void madd(const Lhs& a, const typename base::RhsPacketx4& b, Sum& c, Rhs& unused,
            const Lane& lane) const {
    madd(a, b.get(lane), c, unused, lane);
  }
};

/// Eigen's roots of complex numbers branch on zeros and lose derivatives there.
template <duet::Infinitesimal D>
struct sqrt_impl<std::complex<D>> {
  static std::complex<D> run(const std::complex<D>& z) { return sqrt(z); }
};
template <duet::Infinitesimal D>
struct rsqrt_impl<std::complex<D>> {
  static std::complex<D> run(const std::complex<D>& z) { return 1 / sqrt(z); }
};

} // namespace Eigen::internal

namespace Eigen {

template <duet::Infinitesimal D>
struct NumTraits<D> : NumTraits<duet::real_type_t<D>> {
  using Real = D;
  using NonInteger = D;
  using Nested = D;
  using Literal = duet::real_type_t<D>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 4,
    AddCost = 4,
    MulCost = 8,
  };
  static constexpr D epsilon() { return std::numeric_limits<D>::epsilon(); }
  static constexpr D dummy_precision() {
    return NumTraits<duet::real_type_t<D>>::dummy_precision();
  }
  static constexpr D highest() { return std::numeric_limits<D>::max(); }
  static constexpr D lowest() { return std::numeric_limits<D>::lowest(); }
  static constexpr D infinity() { return std::numeric_limits<D>::infinity(); }
  static constexpr D quiet_NaN() { return std::numeric_limits<D>::quiet_NaN(); }
};

/// Result scalar of a matrix of duals and a matrix of doubles or of duals of another nesting.
template <class A, class B, class Operation>
  requires(!std::same_as<A, B> && duet::detail::MixedScalars<A, B>)
struct ScalarBinaryOpTraits<A, B, Operation> {
  using ReturnType = duet::promote_t<A, B>;
};

} // namespace Eigen

namespace duet {

/// Vector of scalars, each converted to the common type: `make_vector(x, 2, sin(x))`.
template <class... S>
[[nodiscard]] auto make_vector(const S&... s) {
  using common = std::common_type_t<S...>;
  return Eigen::Matrix<common, int(sizeof...(S)), 1>(
      std::array<common, sizeof...(S)>{static_cast<common>(s)...}.data());
}

} // namespace duet

// Eigen's solvers over dual and Taylor numbers with entries that are zero but have derivatives.
//
// Eigen skips work for entries that compare equal to zero, and duals compare by value, so the
// derivatives of such entries would be lost. Two functions matter, and both are replaced here:
// - substitution in triangular systems skips a zero entry of the right-hand side;
// - a Householder reflector is omitted if the entries to be removed are zero already.
//
// So LLT, LDLT, LU and every QR give the derivatives of their solutions, wherever the matrix is
// regular, with Eigen 3.4 as with later ones. Householder reflectors differ from those over
// `double` in one respect: if a column is zero below the diagonal but its derivatives are not,
// there is one, which flips the sign of that row of R and column of Q. At a column that vanishes
// altogether Q has no derivative, and Eigen's choice is kept: no reflector.
//
// Not covered: reflectors of a vector that is not a block of another, `v.makeHouseholder(…)`.
//
// Eigen documents no means to replace the two. The specialised classes, `BlockImpl` and
// `triangular_solve_vector`, are the same in 3.4, 5.0 and its main branch of August 2026; tests
// with DUET_TEST_EIGEN (CONTRIBUTING.md) check others.

namespace duet::detail {

/// Solves a triangular system in place, column by column.
template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate, bool RowMajor>
struct triangular_substitution {
  static void run(Index size, const Lhs* matrix, Index stride, Rhs* x) {
    constexpr bool lower = (Mode & Eigen::Lower) != 0;
    const auto at = [&](Index row, Index column) -> Lhs {
      const Lhs& entry = RowMajor ? matrix[row * stride + column] : matrix[row + column * stride];
      return Eigen::internal::conj_if<Conjugate>()(entry);
    };
    for (Index k = 0; k < size; ++k) {
      const Index i = lower ? k : size - 1 - k;
      if (is_structural_zero(x[i])) {
        continue;
      }
      if constexpr ((Mode & Eigen::UnitDiag) == 0) {
        x[i] /= at(i, i);
      }
      const Index begin = lower ? i + 1 : 0;
      const Index end = lower ? size : i;
      for (Index row = begin; row < end; ++row) {
        x[row] -= at(row, i) * x[i];
      }
    }
  }
};

template <class A, class B>
concept EitherInfinitesimal = Infinitesimal<A> || Infinitesimal<B>;

/// An expression of Eigen over dual or Taylor numbers; its type may be incomplete still.
template <class Expression>
concept InfinitesimalExpression =
    Infinitesimal<typename Eigen::internal::traits<Expression>::Scalar>;

/// Householder reflector H = 1 − τ v vᵀ with H x = (β, 0 … 0)ᵀ and v = (1, essential)ᵀ, as
/// `makeHouseholder` of Eigen:
///
///   β = −sign(x₀) ‖x‖,  essential = tail / (x₀ − β),  τ = (β − x₀) / β
///
/// H = 1 only if the tail of x is zero with all its derivatives, or if x vanishes. The essential
/// part may be the tail of x itself.
template <class Vector, class Essential, class Scalar>
void make_reflector(const Vector& x, Essential& essential, Scalar& tau, Scalar& beta) {
  using std::abs;
  using R = real_type_t<Scalar>;
  const Scalar head = x.coeff(0);
  R largest = abs(innermost(head));
  bool is_reduced = true;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    largest = std::max(largest, R(abs(innermost(x.coeff(i)))));
    is_reduced = is_reduced && is_structural_zero(x.coeff(i));
  }
  if (is_reduced || largest == R(0)) {
    tau = Scalar(0);
    beta = head;
    essential.setZero();
    return;
  }
  Scalar square(0); // of x / largest, which stays in range
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Scalar part = x.coeff(i) / largest;
    square += part * part;
  }
  const Scalar norm = sqrt(square) * largest;
  beta = head >= R(0) ? Scalar(-norm) : norm;
  for (Eigen::Index i = 1; i < x.size(); ++i) {
    essential.coeffRef(i - 1) = x.coeff(i) / (head - beta);
  }
  tau = (beta - head) / beta;
}

} // namespace duet::detail

namespace Eigen::internal {

template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate>
  requires duet::detail::EitherInfinitesimal<Lhs, Rhs>
struct triangular_solve_vector<Lhs, Rhs, Index, OnTheLeft, Mode, Conjugate, ColMajor>
    : duet::detail::triangular_substitution<Lhs, Rhs, Index, Mode, Conjugate, false> {
};

template <class Lhs, class Rhs, class Index, int Mode, bool Conjugate>
  requires duet::detail::EitherInfinitesimal<Lhs, Rhs>
struct triangular_solve_vector<Lhs, Rhs, Index, OnTheLeft, Mode, Conjugate, RowMajor>
    : duet::detail::triangular_substitution<Lhs, Rhs, Index, Mode, Conjugate, true> {
};

} // namespace Eigen::internal

namespace Eigen {

/// Blocks of vectors of dual numbers, from which Eigen's decompositions make their reflectors: as
/// Eigen's own, but with reflectors that keep derivatives.
template <class Expression, int Rows, int Columns, bool InnerPanel>
  requires duet::detail::InfinitesimalExpression<Expression>
class BlockImpl<Expression, Rows, Columns, InnerPanel, Dense>
    : public internal::BlockImpl_dense<Expression, Rows, Columns, InnerPanel> {
public:
  using Base = internal::BlockImpl_dense<Expression, Rows, Columns, InnerPanel>;
  using Base::Base;
  EIGEN_INHERIT_ASSIGNMENT_OPERATORS(BlockImpl)

  template <class Essential, class Scalar>
  void makeHouseholder(Essential& essential, Scalar& tau, Scalar& beta) const {
    duet::detail::make_reflector(this->derived(), essential, tau, beta);
  }
  template <class Scalar>
  void makeHouseholderInPlace(Scalar& tau, Scalar& beta) {
    auto essential = this->tail(this->size() - 1);
    makeHouseholder(essential, tau, beta);
  }
};

} // namespace Eigen

// Functions of Eigen that lose derivatives over dual and Taylor numbers, because they branch on
// values or stop when values have converged. They are rejected at compile time with the function
// to call instead. (Member functions of Eigen's quaternions and matrices cannot be replaced from
// outside: the page "With Eigen" lists those.)

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
