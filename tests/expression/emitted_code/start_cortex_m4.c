/* Copyright (c) 2026 the duet authors. MIT licence, see LICENSE. */

/* Start of a program on the emulated Cortex-M4 of mps2-an386: switches the floating-point unit on, then calls newlib. */

void _start(void);

static void reset(void)
{
  *(volatile unsigned*)0xE000ED88 = 0xF00000; /* CPACR: full access to coprocessors 10 and 11 */
  __asm__ volatile("dsb\n\tisb");
  _start();
}

/* The processor reads it at address 0. */
struct vector_table {
  unsigned end_of_stack;
  void (*reset)(void);
};
__attribute__((section(".vectors"), used)) static const struct vector_table vectors = {0x400000, reset};
