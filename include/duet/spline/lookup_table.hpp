// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <vector>

/// \file
/// Lookup tables of rotations and poses. As files: io/table_file.hpp.

namespace duet {

/// Lookup table of rotations (T = double) or poses (T = dual<double, 1, screw_tag>) at increasing
/// parameters.
template <class T>
struct lookup_table {
  std::vector<real_type_t<T>> parameters; ///< increasing parameters u_0 < u_1 < …
  std::vector<quaternion<T>> elements;    ///< as many unit quaternions or poses

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("parameters", parameters);
    f("elements", elements);
  }
};

} // namespace duet
