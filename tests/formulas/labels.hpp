// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// The labels of the documents' formulas, and the arms.

namespace duet_formulas {

inline constexpr const char* labels[] = {
    "N1",  "N2",  "N3",  "N4",  "N5",  "N6",  "N7",  "N8",  "N9",    "N10",     "N11",  "N12",
    "N13", "N14", "N15", "N16", "N17", "N18", "N19", "N20", "N21",   "N22",     "N23",  "N24",
    "N25", "P1",  "P2",  "P3",  "P4",  "P5",  "P6",  "P7",  "Panda", "iiwa 14", "UR5e", "Baxter"};

} // namespace duet_formulas
