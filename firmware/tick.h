/*
 * Time since reset, in milliseconds, and the waits of the main loop.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Timer 2 raises the low-priority interrupt every millisecond exactly
 * (12 MHz / 16 / 250 / 3). Flash erase and write stop the chip's clock for
 * some milliseconds; those are missing from the count.
 */
#ifndef TICK_H
#define TICK_H

#include <stdint.h>

/* Starts the timer. */
void tick_init(void);

/* Counts one millisecond; low-priority interrupt. */
void tick_count(void);

/* Milliseconds since reset, low 16 bits; for differences up to 65 s. */
uint16_t tick_now(void);

/* The high 16 bits. */
extern volatile uint16_t tick_high;

#endif
