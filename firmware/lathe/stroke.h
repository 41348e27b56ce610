/*
 * Stroke: the slides go somewhere one after the other, and rest.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * X goes first when it moves away from the spindle's axis, so that the tool
 * leaves the work before Z moves; else Z goes first. The rest at the end is
 * longer than the input filter takes, so that a switch closed by the last step
 * is seen before the stroke counts as ended (path_busy()).
 *
 * Main loop only. Steps and steps per second, the feed override has no effect.
 */
#ifndef STROKE_H
#define STROKE_H

#include <stdint.h>

/* How far; set before stroke_begin(). */
extern int16_t stroke_dx;
extern int16_t stroke_dz;
extern uint16_t stroke_rate; /* no axis goes faster than its rapid rate */

void stroke_begin(void);

/* The same, one axis by a distance. */
void stroke_along(uint8_t axis, int16_t distance);

/* Describes the next segment; see path_source(). */
uint8_t stroke_source(void);

#endif
