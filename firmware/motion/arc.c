/* Arc: octants of a circle.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/arc.h"
#include "motion/interpolate.h" /* the run */
#include "motion/path.h"        /* the segment */
#include "motion/stream.h"      /* flags */

#define STEPS (STREAM_STEP_X | STREAM_STEP_Z)
/* 2 steps, unscaled. */
#define RADIUS_LEAST (2 * 256 - 8)
#define ENTRIES_MAX 32767u
#define BEHIND 0xF000u /* a border that has been passed by a few steps */

/*
 * The frame, in arc_arithmetic.asm; p, m and E in 1/256 step.
 *
 * Start values of the decision, see interpolate.h. With s c = p for the major
 * axis and s c = -m (growing) or m (shrinking) for the minor one:
 *
 *       growing     dM =  2p + 1   dm = 1 - 2m   G =  E + 2p - m + 3/2
 *       shrinking   dM = -2p - 1   dm = -1 - 2m  G = -E - 2p - m - 3/2
 *
 * and dm - K / 2 = -2m in both. From the 3/2 something is taken: E favours
 * the inner of two points equally far from the circle, by 1/4 to 1/2 in the
 * sum of both, and 3/16 off the half of it undo that.
 */
extern int32_t arc_p;
extern int32_t arc_m;
extern int16_t arc_dx;
extern int16_t arc_dz;
extern uint8_t arc_growing;
extern uint16_t arc_entries; /* of the run; 0 = none has been made */
extern int16_t arc_rest_p;   /* steps to the end, rounded */
extern int16_t arc_rest_m;
extern uint16_t arc_steps_p;   /* |p| in steps, rounded */
extern uint32_t arc_sine_step; /* 2^24 / R */
extern uint8_t arc_shift;      /* scaled = number >> shift, fits 16 bits */
extern uint16_t arc_root;      /* R / sqrt(2), scaled */
extern uint16_t arc_scaled_p;  /* |p| */
extern uint16_t arc_border;    /* steps from p to R / sqrt(2), rounded */
extern uint8_t arc_signs;
#define P_NEGATIVE 0x01
#define M_NEGATIVE 0x02
#define P_LARGER 0x04
#define SAME_SIZE 0x08
#define END_OUTWARDS 0x10 /* the end is on the side of +m */

void arc_enter(void);    /* p, m: from the centre to the start */
void arc_measure(void);  /* rest, steps and signs of p, m */
void arc_exchange(void); /* p and m */
void arc_mirror_p(void);
void arc_mirror_m(void);
void arc_set_up(void);    /* the decision of the run */
void arc_finish(void);    /* p, m and E behind the run */
void arc_find_root(void); /* from |p|, |m|; arc_missed */

/* |dx (x + x_end) + dz (z + z_end)| / 2 scaled: the square of the circle is
   off by so much at the end, a step by R. */
extern uint32_t arc_missed;

uint8_t arc_major_flags;
uint8_t arc_minor_flags;
uint8_t arc_turns;

static uint8_t outwards; /* flags of a step along +m */
static uint32_t radius;  /* R, scaled */

/* Flags of the same step the other way. */
static uint8_t back(uint8_t flags)
{
    return flags ^ (uint8_t)((flags & STEPS) << 1);
}

/* True when the frame's p must be mirrored for the tool to travel towards
   its positive side. turned: counterclockwise for major X, the other sense
   for Z. */
static uint8_t travels_back(uint8_t turned)
{
    return (arc_signs & M_NEGATIVE ? 1 : 0) != turned;
}

uint8_t arc_begin(void)
{
    uint8_t turned = (path_present.kind & SEGMENT_KIND) == SEGMENT_ARC_CCW;
    uint8_t exchange;

    arc_p = path_present.cx;
    arc_m = path_present.cz;
    arc_dx = path_present.dx;
    arc_dz = path_present.dz;
    arc_enter();
    arc_measure();
    arc_major_flags = STREAM_STEP_X;
    outwards = STREAM_STEP_Z;
    /* The major axis is the one with the smaller coordinate; on the border
       the one on which the tool nears the other axis: p < 0. */
    exchange = arc_signs & P_LARGER;
    if (arc_signs & SAME_SIZE) {
        exchange = (arc_signs & P_NEGATIVE) == travels_back(turned);
    }
    if (exchange) {
        arc_exchange();
        arc_measure();
        arc_major_flags = STREAM_STEP_Z;
        outwards = STREAM_STEP_X;
        turned ^= 1;
    }
    if (travels_back(turned)) {
        arc_mirror_p();
        arc_major_flags = back(arc_major_flags);
    }
    if (arc_signs & M_NEGATIVE) {
        arc_mirror_m();
        outwards = back(outwards);
    }
    arc_entries = 0;
    arc_find_root();
    arc_measure();
    radius = ((uint32_t)arc_root * 181) >> 7;
    arc_sine_step = (0xFFFFFFFFul >> arc_shift) / radius;
    return arc_missed <= radius && arc_shift + (radius >= RADIUS_LEAST) != 0;
}

uint8_t arc_rest_flags(void)
{
    uint8_t flags = 0;

    if (arc_rest_p != 0) {
        flags = arc_rest_p < 0 ? back(arc_major_flags) : arc_major_flags;
    }
    if (arc_rest_m != 0) {
        flags |= arc_rest_m < 0 ? back(outwards) : outwards;
    }
    return flags;
}

static uint16_t size(int16_t value)
{
    return value < 0 ? -value : value;
}

uint16_t arc_left(void)
{
    uint16_t along = size(arc_rest_p);
    uint16_t across = size(arc_rest_m);

    return along > across ? along : across;
}

/* Behind a growing octant the axes change places; a run that has stopped
   short of the border goes on in the same one. */
static void turn_frame(void)
{
    uint8_t old = arc_major_flags;

    arc_finish();
    arc_measure();
    if (arc_growing && (arc_border == 0 || arc_border > BEHIND)) {
        arc_exchange();
        arc_mirror_p();
        arc_measure();
        arc_major_flags = back(outwards);
        outwards = old;
    }
}

/* True within a step of the end, unless the arc begins there and goes the
   long way round. */
static uint8_t at_goal(void)
{
    if (arc_left() > 1) {
        return 0;
    }
    if (arc_entries != 0 || arc_rest_p > 0) {
        return 1;
    }
    return arc_rest_p == 0 && (arc_rest_m < 0) == !(arc_signs & P_NEGATIVE);
}

uint16_t arc_next(void)
{
    uint16_t entries;

    if (arc_entries != 0) {
        turn_frame();
    }
    if (at_goal()) {
        return 0;
    }
    arc_growing = !(arc_signs & P_NEGATIVE) || arc_steps_p == 0;
    entries = arc_growing ? arc_border : arc_steps_p;
    if (entries == 0 || entries > BEHIND) {
        entries = 1;
    } else if (entries > ENTRIES_MAX) {
        entries = ENTRIES_MAX;
    }
    arc_minor_flags = arc_growing ? back(outwards) : outwards;
    arc_turns = !arc_growing;
    /* The end in this run: at most a step beyond the extremum, never beyond
       the border, where the path is steeper than a diagonal step. */
    if ((arc_signs & END_OUTWARDS) && arc_rest_p >= 0 &&
        (uint16_t)arc_rest_p <= entries + arc_turns) {
        entries = (uint16_t)arc_rest_p;
        arc_turns = 0;
    }
    run_sine = (((uint32_t)arc_scaled_p << 16) / radius) << 8;
    if (arc_growing && (arc_signs & P_NEGATIVE)) {
        run_sine = -run_sine; /* up to half a step before the extremum */
    }
    arc_entries = entries;
    arc_set_up();
    return entries;
}
