// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// The labels of the documents' formulas, and the arms.

// Parts that our copy of the lecture notes has lost, and what they are taken for:
//
// N1, N2    arrows, dots and stars: p q = (p0 q0 − p·q, p0 q + q0 p + p × q), (p q)* = q* p*
// N4, N5    q, û, θ and the exponent ρ: q = |q| exp(û θ), q^ρ = |q|^ρ (cos ρθ + û sin ρθ)
// N6        all dots: d/dt (p q) = ṗ q + p q̇
// N7        ω^b, as the copy repeats ω^s = 2 q̇ q*: ω^b = 2 q* q̇, from the legible q̇ = ½ q ω^b
// N8        the second matrix, except for its first row: G(q) of ω^b = 2 G(q) q̇
// N9, N19   stars and exponents of SLERP, all of ScLERP: A1 (A1* A2)^τ, A (A* B)^τ
// N11       1/a: D⁻¹ = 1/a (1 − ε b/a)
// N12       the vector product of dual vectors: D × E, by N10 in every component
// N14       the vector product of the second form: (D0 E0 − D·E, D0 E + E0 D + D × E)
// N15       all after "Conjugate of A": the literature's three conjugates; the first is that of N16
// N16       the star of the condition: A A* = 1, from the legible (a) and (b) below it
// N18       dots, as ṗ is in both terms: Ȧ = α̇ + ½ ε (ṫ α + t α̇)
// N20       v^s: ṫ + t̂ ω^s, from the legible J2 of N21
// N22       the inverse in B: B = Jᵀ (J Jᵀ)⁻¹ J2
// N23, N24  the step and the steps 1 to 3 of the algorithm, except for the constant β:
//           Θ(t + h) = Θ(t) + β B (γ(t + h) − γ(t));
//           a step of ScLERP towards the goal, then this one

namespace duet_formulas {

inline constexpr const char* labels[] = {
    "N1",  "N2",  "N3",  "N4",  "N5",  "N6",  "N7",  "N8",  "N9",    "N10",     "N11",  "N12",
    "N13", "N14", "N15", "N16", "N17", "N18", "N19", "N20", "N21",   "N22",     "N23",  "N24",
    "N25", "P1",  "P2",  "P3",  "P4",  "P5",  "P6",  "P7",  "Panda", "iiwa 14", "UR5e", "Baxter"};

} // namespace duet_formulas
