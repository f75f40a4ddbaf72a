// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// The style of all pictures.

namespace example {

/// Pictures are as wide as the text of a page, in pixels of it; PNG files have twice as many.
inline constexpr int picture_width = 830;

/// The head of every script. Colours are those of Okabe and Ito, which colour-blind readers can
/// distinguish, without those too pale for letters on white. The background is white on dark pages,
/// too. Names stand next to their curves instead of in a key.
inline constexpr const char* picture_style = R"(reset
set encoding utf8
set datafile separator ','
blue = '#0072b2'
vermillion = '#d55e00'
green = '#00805d'
purple = '#a8497c'
orange = '#b37700'
ink = '#24292f'
grey = '#6e7781'
pale = '#c4ccd4'
set linetype 1 lc rgb blue lw 2
set border 3 lc rgb grey
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lt 1 lw 1 lc rgb '#e4e8ec'
set title textcolor rgb ink
set xlabel textcolor rgb ink
set ylabel textcolor rgb ink
set zlabel textcolor rgb ink
set style fill solid noborder
unset key
)";

} // namespace example
