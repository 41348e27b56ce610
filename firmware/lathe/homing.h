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
 * At the latch rate a step lasts longer than a switch bounces (5 ms) and the
 * input filter takes (4 ms, 2 more for each sample hit by interference), so
 * the stream is stopped before the next step and the count is exact.
 *
 * Where the screw stands at zero is compared with the homing before: by
 * counting, if the position has been known since then, and else by the phase
 * of the coils, which tells it but for multiples of four steps; without power
 * too, because a rotor goes to the nearest place of the phase it is given.
 * Step/direction outputs tell no phase. What was found is stored even when it
 * is an alarm, so the next homing compares with it.
 *
 * Main loop only.
 */
#ifndef HOMING_H
#define HOMING_H

#include <stdint.h>

/* Starts with X if it is one of the axes; of those that are known the
   position has been trusted so far. Both: HOMED_AXIS_... */
void homing_begin(uint8_t axes, uint8_t known);

#define HOMING_DONE 0xFF

/* Moves on when a phase has ended. Returns 0 while homing, HOMING_DONE when
   all axes are parked, or the ALARM_... that ended it, with homing_axis as
   its detail. */
uint8_t homing_poll(void);

/* The axis being homed, AXIS_X or AXIS_Z. */
extern uint8_t homing_axis;

/* The axes given to homing_begin(). */
extern uint8_t homing_axes;

/* Largest less smallest count of the last homing by axis, at most 255. */
extern uint8_t homing_spread[2];

/* WARNING_...: the dead steps have changed since the homing before. */
extern uint8_t homing_warnings;

#endif
