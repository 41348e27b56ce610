/*
 * Switches, buttons, contact sensor: filtered, one bit each, 1 = active.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * inputs_tick() samples all of them every millisecond in the low-priority
 * interrupt; an input changes its bit here only after four equal samples in
 * a row, so a pulse shorter than 3 ms never counts and a change is seen 3 to
 * 4 ms late. The four-sample counters are two bits per input, held in two
 * bytes and advanced for all inputs at once.
 */
#ifndef INPUTS_H
#define INPUTS_H

#include <stdint.h>

#define INPUT_LIMIT_X 0x01
#define INPUT_LIMIT_Z 0x02
#define INPUT_ESTOP 0x04
#define INPUT_RUN 0x08
#define INPUT_HOLD 0x10
#define INPUT_STOP 0x20
#define INPUT_PROBE 0x40 /* contact; 0 where no sensor is fitted */
#define INPUT_LIMITS (INPUT_LIMIT_X | INPUT_LIMIT_Z)

/* Filtered state. */
extern volatile uint8_t inputs_state;

/* Takes the present levels as they are; call once after reset. */
void inputs_init(void);

/* Samples and filters; low-priority interrupt, once a millisecond. */
void inputs_tick(void);

/* Buttons pressed since the last call, each press reported once. */
uint8_t inputs_take_presses(void);

#endif
