// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <Eigen/Core>

#include <concepts>

/// \file
/// Eigen's product of large matrices of different scalars, dual times double among them.

namespace duet::detail {

template <class Lhs, class Rhs>
concept MixedFactors = (Infinitesimal<Lhs> || Infinitesimal<Rhs>)&&!std::same_as<Lhs, Rhs>;

/// An architecture no processor has, to reach Eigen's generic kernel from its specialisation.
inline constexpr int no_architecture = -1;

} // namespace duet::detail

namespace Eigen::internal {

/// Eigen's kernel puts each product a·b into a variable of b's type before it is added, which does
/// not compile where b is the narrower of the two.
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

} // namespace Eigen::internal
