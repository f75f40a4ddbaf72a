// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/expression/evaluate/given.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
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
struct part_of_dual {
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
  template <class X, class DX>
  static constexpr auto differential(X, DX dx) {
    return apply<part_of_dual>(dx);
  }
  template <int I>
  static constexpr auto simplified(unit_vector_node<kind::dual_vector, I>) {
    if constexpr ((I < 3) != Dual) {
      return unit_vector_node<kind::vector, I % 3>{};
    } else {
      return zero_node<kind::vector>{};
    }
  }
  template <class X>
  static constexpr auto simplified(X) {
    if constexpr (is_zero<X>) {
      return zero_of<kind_of(X::kind_of)>();
    } else {
      return applied_node<part_of_dual, X>{};
    }
  }
  static printed print(notation style, const printed& x) {
    return detail::printed_call(style, {Dual ? "dual_part" : "real_part", ""}, x.text);
  }
};

/// p of a rigid motion p + εq, whose velocity is known from that of the motion.
struct rotation {
  static constexpr kind kind_of(kind) { return kind::quaternion; }
  template <class A>
  static auto value(const A& a) {
    return duet::rotation(a);
  }
  template <class A, class DA>
  static constexpr auto differential(A, DA da) {
    return apply<rotation>(da);
  }
  static printed print(notation style, const printed& a) {
    return detail::printed_call(style, {"rotation", ""}, a.text);
  }
};

/// a − εb.
struct dual_conj {
  static constexpr kind kind_of(kind k) { return k; }
  template <class X>
  static constexpr auto simplified(X x) {
    if constexpr (is_applied<X, dual_conj>) {
      return operand<0>(x);
    } else if constexpr (is_zero<X>) {
      return x;
    } else {
      return applied_node<dual_conj, X>{};
    }
  }
  template <class X>
  static constexpr auto value(const X& x) {
    if constexpr (Scalar<X> && !detail::is_screw_dual<X>) {
      return x; // a real number
    } else {
      return duet::dual_conj(x);
    }
  }
  template <class X, class DX>
  static constexpr auto differential(X, DX dx) {
    return apply<dual_conj>(dx);
  }
  static printed print(notation style, const printed& x) {
    return style == notation::latex ? printed{"\\overline{" + x.text + "}"}
                                    : printed{"dual_conj(" + x.text + ")"};
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
template <PoseTerm A>
[[nodiscard]] constexpr auto point_conj(const A& a) {
  return dual_conj(conj(a));
}

} // namespace duet::expression
