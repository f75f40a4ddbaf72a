// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/eigen_refused.hpp>
#include <duet/dual/eigen_solvers.hpp>
#include <duet/dual/eigen_structure.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <array>
#include <complex>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Dual and Taylor numbers as scalars of Eigen, in mixed expressions with double too.

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
