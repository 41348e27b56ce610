/*
 * Products and proportions of 16-bit numbers, in arithmetic.asm: a call costs
 * 20 bytes where the operators of C take 60.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Put the numbers into the variables, in any order, right before the call; the
 * operators * / % use the same ones. Main loop only.
 */
#ifndef ARITHMETIC_H
#define ARITHMETIC_H

#include <stdint.h>

extern uint16_t factor_1;
extern uint16_t factor_2;
extern uint16_t divisor;

/* factor_1 * factor_2; 190 cycles. */
uint32_t product(void);

/* factor_1 * factor_2 / divisor, rounded down; 1,200 cycles. The quotient must
   fit 16 bits. */
uint16_t proportion(void);

/* Takes the last decimal digit off what proportion() has found, be it more than
   16 bits; what is left has its lower 16 bits in factor_1. 1,000 cycles. */
uint8_t proportion_digit(void);

#endif
