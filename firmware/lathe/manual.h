/*
 * Manual motion: jog, goto, and the search for contact with the work.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   JOG    Homed: the target must lie inside the soft limits, 0 to -travel in
 *          tool positions. Not homed: at most at the homing rate, and never
 *          on towards a switch that is pressed: the way out of a limit alarm.
 *          It ends like a HOLD when the host is not heard for a while.
 *   GOTO   the same, only homed, and whether the host is heard or not.
 *   TOUCH  the same as JOG, only homed, at the latch rate, until the contact
 *          sensor closes. A step lasts longer than the input filter takes, so
 *          the tool stops on the step that closed the contact.
 *
 * In JOG and GOTO the limit switches that are open at the start stop the
 * motors, homed or not. So does the contact of a sensor that is open at the
 * start, when the move is faster than 255 step/s.
 *
 * Main loop only.
 */
#ifndef MANUAL_H
#define MANUAL_H

#include <stdint.h>

/* How the last TOUCH ended: STATUS_INPUT_TOUCHED, else 0. */
extern uint8_t manual_contact;

/* command: COMMAND_JOG, _GOTO or _TOUCH; x, z: tool positions, less than 32,768
   steps away; rate: step/s, 0 rapid, without effect on TOUCH; wait, of a JOG:
   it ends when the host is not heard for so long, ms, 0 never. A TOUCH waits
   DEADMAN_MS. Returns ERROR_OK or why not. */
uint8_t manual_begin(uint8_t command, int16_t x, int16_t z, uint16_t rate,
                     uint16_t wait);

/* A request has come from the host. */
void manual_heard(void);

/* In MOVING and TOUCHING; 1 when the motion has ended. */
uint8_t manual_poll(void);

#endif
