/*
 * Roughing and finishing passes of a stored part, computed as they are cut.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A contour is roughed in levels, spread evenly between the material and the
 * contour, so that none is deeper than the depth of cut and none is a sliver:
 *
 *   along Z    levels of x; a pass runs towards the chuck until the contour
 *              rises above its level. Behind it the contour may fall again:
 *              each pocket is cut to its bottom before the next one.
 *   facing     levels of z; a pass runs from outside to the contour.
 *
 * Then the tool follows the contour, in one chain without a stop: at the
 * finish allowance, on size, and again for every spring pass. A plunge goes
 * straight in, place by place.
 *
 * A pass: over to its place at a height where everything has been cut, in to
 * its level (rapid where the material in front has gone, at the feed where it
 * has not), cut, back off by the retract. What is material and what is air is
 * asked from lathe/contour.h, so rapid moves run through air alone.
 *
 * Before a pause, before another tool and at the end X, then Z go to park.
 *
 * Main loop only. The part must have passed part_check().
 */
#ifndef PASSES_H
#define PASSES_H

#include <stdint.h>

/* Prepares the part in a slot; step: pause after every operation. What lies
   before the place `from` has been cut already and is left out; 1 = nothing
   (lathe/places.h). */
void passes_begin(uint8_t slot, uint8_t step, uint8_t from);

/* Describes the next move in path_next and path_rate; 0 when the tool is
   back at park. passes_more: the part goes on behind it, a chain of its own,
   when path_begin() is called again. */
uint8_t passes_source(void);
extern uint8_t passes_more;

/* What the tool is doing now, for the operator: operation 1..operations,
   pass 1..passes (0 = on the way; passes 0 = not known: the next operation is
   being worked out already). */
uint8_t passes_operation(void);
uint8_t passes_pass(void);
uint8_t passes_passes(void);

#endif
