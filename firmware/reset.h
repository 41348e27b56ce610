/*
 * Why the chip last started.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef RESET_H
#define RESET_H

#include <stdint.h>

/* Copied by startup.asm before anything changes them. */
extern volatile uint8_t reset_rcon;
extern volatile uint8_t reset_stkptr;

/* RESET_CAUSE_... */
uint8_t reset_cause(void);

#endif
