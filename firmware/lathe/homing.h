/*
 * Homing: finds the limit switch of each axis, X first so that the tool
 * leaves the work, then Z, and measures the dead steps on the way.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   per axis
 *     LEAVE    only if the switch is pressed at the start: away from it
 *              until it opens
 *     SEEK     towards the switch at the homing rate until it closes
 *     LEAVE    away from it at the homing rate until it opens
 *     LATCH    towards it at the latch rate until it closes    \  repeated,
 *     COUNT    away at the latch rate until it opens: count    /  median
 *     PARK     PARK_STEPS away
 *
 * The steps counted from closing to opening are the ones that turn the screw
 * without moving the slide, then those of the switch's own travel, then the
 * one that opened it:   dead steps = count - 1 - setting switch_travel.
 * Where the switch opens is machine zero: the release edge is the one that
 * repeats best.
 *
 * At the latch rate a step lasts longer than the input filter (4 ms), so the
 * stream is stopped before the next step and the count is exact.
 *
 * Main loop only.
 */
#ifndef HOMING_H
#define HOMING_H

#include <stdint.h>

/* Starts with X. */
void homing_begin(void);

#define HOMING_DONE 0xFF

/* Moves on when a phase has ended. Returns 0 while homing, HOMING_DONE when
   both axes are parked, or the ALARM_... that ended it, with homing_axis as
   its detail. */
uint8_t homing_poll(void);

/* The axis being homed, AXIS_X or AXIS_Z. */
extern uint8_t homing_axis;

#endif
