/*
 * Slopes and arcs of shape_check.c: what needs numbers of 32 bits, which byte
 * code (firmware/bytecode/README.md) does not have.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Main loop only.
 */
#ifndef SHAPE_ARITHMETIC_H
#define SHAPE_ARITHMETIC_H

#include <stdint.h>

/* True when dx steps across for dz steps along are steeper than a slope in
   1/SLOPE_UNIT. */
uint8_t shape_steeper(uint16_t dx, uint16_t slope, uint16_t dz);

/* Distance of the start and the end of the arc that contour_next() has read
   from its centre. */
uint16_t shape_radius(void);
uint16_t shape_end_radius(void);

#endif
