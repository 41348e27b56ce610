/*
 * Checks a part image in a slot, whole, before it may be stored or cut.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * The chip trusts nothing that arrives: every field is compared with the
 * limits of link/protocol.toml and with the machine's settings, in the order
 * given there, and no field is used in arithmetic before its range is known.
 * Main loop only; about 2 ms per operation.
 */
#ifndef PART_CHECK_H
#define PART_CHECK_H

#include <stdint.h>

/* Operation that was refused, counted from 1; 0 = the part as a whole. */
extern uint8_t part_check_operation;

/* length: bytes of the image. Returns 0 or REFUSAL_... */
uint8_t part_check(uint8_t slot, uint16_t length);

/* Fastest feed that may be asked for, steps/s: both axes must reach it from
   standstill. */
uint16_t part_check_max_rate(void);

#endif
