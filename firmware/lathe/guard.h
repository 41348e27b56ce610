/*
 * Guard: what must stop the motors within a millisecond, whatever the main
 * loop is doing.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * guard_tick() runs in the low-priority interrupt, every millisecond, right
 * after the inputs have been filtered:
 *   emergency stop                  stream ends, coils off      guard_tripped
 *   limit switch while it is armed  stream ends, coils hold     guard_tripped
 *   contact while it is armed       stream ends, coils hold     guard_tripped
 *   the stream ran dry in mid-move  (it has stopped itself)     guard_tripped
 *   switch or contact waited for    stream ends                 guard_stopped
 * The main loop finds the flag in its next turn and names the alarm.
 */
#ifndef GUARD_H
#define GUARD_H

#include <stdint.h>

/* What tripped: input bits (INPUT_ESTOP, _LIMIT_X, _LIMIT_Z, _PROBE), or
   GUARD_DRY.
   Stays until guard_clear(). */
#define GUARD_DRY 0x80
extern volatile uint8_t guard_tripped;

/* The switch given to guard_stop_at() has reached the wanted state. */
extern volatile uint8_t guard_stopped;

/* Inputs that trip: set by the main loop. */
extern volatile uint8_t guard_armed;

/* Forgets what tripped. */
void guard_clear(void);

/* Stops the stream as soon as an input is active (level 1) or not (0); input
   0 = none. */
void guard_stop_at(uint8_t input, uint8_t level);
extern volatile uint8_t guard_stop_input;
extern volatile uint8_t guard_stop_inverted; /* input where level is 0 */

/* Low-priority interrupt, once a millisecond. */
void guard_tick(void);

#endif
