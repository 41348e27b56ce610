/*
 * Switches, buttons, contact sensor: filtered, one bit each, 1 = active.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Sampled every millisecond in the low-priority interrupt. A sample is the
 * majority of two readings and the bit as it is, so a pulse that is over
 * before the second reading does not count. A bit changes when four more
 * samples were against it than for it: a pulse shorter than 3 ms never
 * counts, a change is seen 3 to 4 ms late, and interference during that time
 * adds 2 ms for each sample that it hits. The leads are two bits per input,
 * held in two bytes and counted for all inputs at once.
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

/* First reading, then the second one and the filter: low-priority interrupt,
   once a millisecond, with other work between them. */
void inputs_read(void);
void inputs_tick(void);

/* Buttons pressed since the last call, each press reported once. */
uint8_t inputs_take_presses(void);

#endif
