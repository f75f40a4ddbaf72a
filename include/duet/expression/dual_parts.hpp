// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/expression/evaluate/given.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/vector.hpp>

/// \file
/// Real and dual parts of dual numbers, dual vectors and dual quaternions a + εb, and the
/// conjugates a − εb (N10, N13, N15).

namespace duet::expression {

namespace op {

/// a or b of a + εb; what is made of dual numbers becomes what is made of real ones.
template <bool Dual>
struct part_of_dual : linear_operation {
  static constexpr detail::function_name name = {Dual ? "dual_part" : "real_part", ""};
  static constexpr kind kind_of(kind k) {
    return k == kind::dual_vector ? kind::vector : k == kind::pose ? kind::quaternion : k;
  }
  template <class X>
  static auto value(const X& x) {
    if constexpr (detail::is_screw_dual<X>) {
      return Dual ? x.epsilon() : x.value();
    } else if constexpr (Scalar<X>) { // a real number
      return Dual ? X(0) : x;
    } else if constexpr (Dual) {
      return duet::dual_part(x);
    } else {
      return duet::real_part(x);
    }
  }
  template <class V>
    requires(V::kind_of == kind::vector && !Dual)
  static constexpr auto simplified(V v) { return v; }
  template <int I>
  static constexpr auto simplified(unit_vector_node<kind::dual_vector, I>) {
    if constexpr ((I < 3) != Dual) {
      return unit_vector_node<kind::vector, I % 3>{};
    } else {
      return zero_node<kind::vector>{};
    }
  }
};

/// p of a rigid motion p + εq, whose velocity is known from that of the motion.
struct rotation : linear_operation {
  static constexpr detail::function_name name = {"rotation", ""};
  static constexpr kind kind_of(kind) { return kind::quaternion; }
  static auto value(const auto& a) { return duet::rotation(a); }
};

/// a − εb.
struct dual_conj : linear_operation {
  static constexpr detail::function_name name = {"dual_conj", "\\overline{#}"};
  static constexpr kind kind_of(kind k) { return k; }
  template <class X>
  static constexpr auto simplified(applied_node<dual_conj, X>) {
    return X{};
  }
  template <class X>
  static constexpr auto value(const X& x) {
    if constexpr (Scalar<X> && !detail::is_screw_dual<X>) {
      return x; // a real number
    } else {
      return duet::dual_conj(x);
    }
  }
};

} // namespace op

/// a of a + εb: of a dual number, such as the product of two lines, of a dual vector, and of a dual
/// quaternion, of which it is the rotation if it is unit.
template <Term X>
  requires(!VectorTerm<X> && !QuaternionTerm<X>)
[[nodiscard]] constexpr auto real_part(const X& x) {
  if constexpr (PoseTerm<X>) {
    return apply<op::rotation>(x);
  } else {
    return apply<op::part_of_dual<false>>(x);
  }
}
/// b of a + εb.
template <Term X>
  requires(!VectorTerm<X> && !QuaternionTerm<X>)
[[nodiscard]] constexpr auto dual_part(const X& x) { return apply<op::part_of_dual<true>>(x); }
/// a − εb of a dual number (N10) or dual quaternion, its second conjugate (N15).
template <Term X>
  requires(ScalarTerm<X> || PoseTerm<X>)
[[nodiscard]] constexpr auto dual_conj(const X& x) { return apply<op::dual_conj>(x); }
/// N15: the third conjugate p* − εq* of p + εq, which carries points: A (1 + εx) A^(3).
[[nodiscard]] constexpr auto point_conj(const PoseTerm auto& a) { return dual_conj(conj(a)); }

} // namespace duet::expression
