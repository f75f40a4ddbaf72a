// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: the axis and angle of a rotation lose derivatives at the identity: rotation_vector

#include <duet/interop/eigen.hpp>

using D = duet::dual<double>;
using matrix = Eigen::Matrix<D, 3, 3>;
using points = Eigen::Matrix<D, 3, 5>;

#ifdef DUET_MUST_FAIL
D angle(const Eigen::Quaternion<D>& q) {
  Eigen::AngleAxis<D> a(q);                    // mistake
  Eigen::AngleAxis<D> b(q.toRotationMatrix()); // mistake
  a = q;                                       // mistake
  a = q.toRotationMatrix();                    // mistake
  b.fromRotationMatrix(q.toRotationMatrix());  // mistake
  const points p = points::Zero();
  static_cast<void>(Eigen::umeyama(p, p));        // mistake
  static_cast<void>(Eigen::umeyama(p, p, false)); // mistake
  return a.angle();
}
#else
D angle(const Eigen::Quaternion<D>& q) {
  const Eigen::AngleAxisd plain(Eigen::Quaterniond(1, 0, 0, 0));
  const Eigen::AngleAxis<D> a(plain.angle(), plain.axis().cast<D>());
  return duet::rotation_vector(duet::from_eigen(q)).norm() + a.angle();
}
#endif
