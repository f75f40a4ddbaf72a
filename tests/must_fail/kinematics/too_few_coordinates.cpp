// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a chain takes as many coordinates as it has moving joints

#include <duet/kinematics/robots.hpp>

#ifdef DUET_MUST_FAIL
using coordinates = Eigen::Matrix<double, 6, 1>;
#else
using coordinates = Eigen::Matrix<double, 7, 1>;
#endif

auto tip(const coordinates& theta) { return duet::robots::panda().pose(theta); }
