# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The documents write mathematics as $…$ and $$…$$; Doxygen wants \f$…\f$ and \f[…\f].
s/\$\$([^$]+)\$\$/\\f[\1\\f]/g
s/\$([^$]+)\$/\\f\x01\1\\f\x01/g
s/\x01/$/g
# A link to a heading of the same page has no address that Doxygen knows: its text is left.
s/\[([^]]+)\]\(#[^)]*\)/\1/g
