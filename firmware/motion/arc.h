/*
 * Arc: cuts a circular arc into its octants, the runs of interpolate.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Everything is seen in the frame of the octant: p counts along the major
 * axis in the direction of travel, m along the minor axis outwards, both
 * from the centre. Then all octants look like one of two:
 *
 *       m                      growing: p from 0 to R / sqrt(2), the minor
 *       |___ shrinking             axis steps inwards
 *       |   \  growing ->      shrinking: p from -R / sqrt(2) to 0, the minor
 *     __|____\_____ p              axis steps outwards
 *
 * Behind a growing octant the axes change places, p' = -m, m' = p; behind a
 * shrinking one only the minor axis turns back.
 *
 * Main loop only. Radius 2 to 60,000 steps; less than a full circle. The
 * circle goes through the start exactly; where the centre is off, so that it
 * misses the end by up to a step, the last entry goes there.
 */
#ifndef ARC_H
#define ARC_H

#include <stdint.h>

/* Flags of the run's entries. */
extern uint8_t arc_major_flags; /* step and sign of the major axis */
extern uint8_t arc_minor_flags;
extern uint8_t arc_turns; /* the minor axis turns back at the run's end */

/* Takes path_present, of kind SEGMENT_ARC_... Returns 0 when there is no such
   arc: less than 2 steps of radius, or the circle through the start misses
   the end by more than a step. */
uint8_t arc_begin(void);

/* Sets the next run up; returns its entries, 0 when the arc is complete but
   for arc_rest_flags(). */
uint16_t arc_next(void);

/* Step still missing at the end, or 0. */
uint8_t arc_rest_flags(void);

/* Entries at least to come from here to the end. */
uint16_t arc_left(void);

/* Square root of root_of, rounded down, 700 cycles; an arc under way is not
   disturbed. */
extern uint32_t root_of;
uint16_t root_find(void);

#endif
