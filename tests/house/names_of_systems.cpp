// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Names that system headers define as macros, above all those of Windows, are not used as
// identifiers. Headers that other libraries need are included before.

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
