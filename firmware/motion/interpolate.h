/*
 * Interpolation: turns one monotone run of a line or an arc into entries of
 * the step ring, each grid point being the one nearest to the true path.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A run has a major axis, which steps in every entry, and a minor axis, which
 * steps in some; a line is one run, an arc one per octant. Two flag bytes
 * say what a straight and what a diagonal entry are. Additions only.
 *
 * Line: run_error starts at half of run_major; each entry takes run_minor
 * away, and where it would become negative the minor axis steps and
 * run_major is added. 21 cycles per entry.
 *
 * Arc: with E = X^2 + Z^2 - R^2, dM and dm the changes of E by a step of the
 * major and of the minor axis, the nearer of the two next points is the
 * diagonal one when E_straight + E_diagonal has the sign of E_straight. Half
 * that sum is the decision G = E + dM + dm / 2; all three change by additions
 * (see path.c for the start values):
 *
 *       every entry      dM += K          G += dM
 *       diagonal too     dm += K          G += dm - K / 2
 *
 * K is the second difference of E, 2, negated with everything else where the
 * path approaches an axis of the circle. All are in 1/256 of a step squared
 * (so the centre may have 8 fractional bits), 32 bits. 35 cycles per straight
 * entry, 48 per diagonal one.
 *
 * The path length of an entry is R / sqrt(R^2 - c^2) for a distance c of the
 * major coordinate from the centre: a table by 256 c / R, which grows or
 * shrinks by a constant from entry to entry.
 *
 * Main loop only; run_batch entries must have room.
 */
#ifndef INTERPOLATE_H
#define INTERPOLATE_H

#include <stdint.h>

/* The run, set by path.c. */
extern uint8_t run_straight; /* flags of an entry */
extern uint8_t run_diagonal;
extern uint8_t run_batch; /* entries to make, 1..255; counts down to 0 */
extern uint8_t run_head;  /* offset in the ring behind the last entry made */

/* Line. */
extern uint8_t run_stretch;
extern uint16_t run_error;
extern uint16_t run_major;
extern uint16_t run_minor;

/* Arc. */
extern int32_t run_change_major; /* dM */
extern int32_t run_change_minor; /* dm - K / 2 */
extern int32_t run_decision;     /* G */
extern int16_t run_curve;        /* K / 256: 2 or -2 */
extern uint32_t run_sine;        /* 256 c / R, 16 fractional bits, 24 used */
extern int32_t run_sine_step;

/* Make run_batch entries, starting at run_head. The caller publishes them by
   stream_head = run_head. */
void interpolate_line(void);
void interpolate_arc(void);

/* stretch of a line or tangent with slope minor/major = s / 256 */
uint8_t interpolate_stretch(uint8_t s);

#endif
