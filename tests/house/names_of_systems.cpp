// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Names that the headers of systems define as macros, those of Windows above all, are nobody's
// identifiers. What other libraries need is included before.

#include "everything_else.hpp"

#define near
#define far
#define small char
#define hyper long
#define interface struct
#define pascal
#define cdecl
#define IN
#define OUT
#define OPTIONAL
#define CONST const
#define VOID void
#define ERROR 0
#define NO_ERROR 0
#define DELETE 1
#define STRICT 1
#define TRUE 1
#define FALSE 0
#define DOMAIN 1
#define OVERFLOW 3
#define UNDERFLOW 4
#define PI 3
#define M_PI 3
#define major(x) x
#define minor(x) x
#define unix 1
#define linux 1

#include "everything.hpp"

int main() {}
