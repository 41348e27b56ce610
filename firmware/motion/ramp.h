/*
 * Ramp: the speed along the path.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * In each tick of 1/1024 s the speed moves by one acceleration step towards
 * the speed wanted (the segment's, times the override, or the start/stop speed
 * for a hold), but never so high that the way left to the next corner, and
 * the speed planned there, no longer suffices to brake. The plan is kept in
 * braking distances w = v^2 / (2 a), because then it takes only additions:
 * a segment may be entered with w_entry = min(w_corner, w_exit + length).
 *
 *      w |      ___________                 w_exit + way left
 *        |    /            \  <- braking starts where the lines meet
 *        |   /              \____
 *        |__/____________________\____ way
 *
 * Time is the steps' own: speed / 1024 + 1 entries go by at a speed, and then
 * come as many ticks as a ramp that follows every one of them would have used
 * for that way (stretch included). So v^2 = v0^2 + 2 a s, however coarse, and
 * the braking distances hold. No clock is looked at: which entry gets which
 * speed depends on the segments alone, not on when USB lets this run, as long
 * as the main loop keeps the queues filled and this is done before the speed
 * is over (half a millisecond or more; else the next entry takes it).
 *
 * The new period goes to the step interrupt through stream_period, and the
 * place in the ring of the entry that takes it through ramp_at. A hold and an
 * override act with the very next entry. Nothing is ever locked out.
 *
 * Units: speeds 1/256 step/s (24 bits); distances 1/2 step (16 bits, up to
 * 32,767 steps); path counted in entries.
 */
#ifndef RAMP_H
#define RAMP_H

#include <stdint.h>

/* The segment being executed; written by path.c and ramp_tick(). */
extern volatile uint8_t ramp_segment; /* index into segments[] */

/* Percent of the programmed feed, 10..200; rapids keep theirs. Main loop. */
void ramp_set_override(uint8_t percent);

/* Braking distance from the start/stop speed, 1/2 step: what may be left at
   the end of a chain. */
extern volatile uint16_t ramp_stop;
void ramp_set_stop(void); /* once that speed is set (set_up.c) */

/* Speed now, 1/256 step/s. */
extern volatile uint32_t ramp_speed;

/* Braking distance from a speed, step/s, in 1/2 steps. Main loop. */
uint16_t ramp_distance(uint16_t speed);

/* The speed, or less: the fastest that can be braked from within 30,000 steps.
   Main loop. */
uint16_t ramp_cap(uint16_t speed);

/* Starts at the start/stop speed with the segment given, or held at once
   after a ramp_hold() since ramp_end(). */
void ramp_begin(uint8_t segment);

/* Forgets speed and hold; before a chain. */
void ramp_end(void);

/* Brakes from the next entry on and stops at the start/stop speed; then
   ramp_held() is true. */
void ramp_hold(void);
uint8_t ramp_held(void);
uint8_t ramp_holding(void); /* from ramp_hold() to ramp_release() */

/* Goes on. */
void ramp_release(void);

/* Low-priority interrupt, when the step interrupt has taken a period over. */
void ramp_tick(void);

#endif
