/* Ramp: set-up, hold and override; the work is in ramp_tick.asm.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/ramp.h"
#include "motion/path.h"   /* segments */
#include "motion/stream.h" /* orders */
#include "sfr.h"           /* INTCON */

#define GIEL_MASK 0x40

/* ramp_tick.asm */
extern volatile uint32_t ramp_start;
extern volatile uint16_t ramp_scale; /* override, 256 = 100 % */
extern volatile uint8_t ramp_flags;
extern volatile uint16_t ramp_brake_speed;
extern volatile uint16_t ramp_brake_distance;
extern volatile uint16_t ramp_way;
void ramp_brake(void);
void ramp_set_period(void);
void ramp_arm(void);

/* step_interrupt.asm */
extern volatile uint8_t ramp_at;
extern volatile uint8_t stream_next;

/* For ramp_at: entries begin at even places. */
#define NO_ENTRY 1

/* Longest way to brake that can be planned, 1/2 step. */
#define DISTANCE_FAR 60000u

#define RUNNING 0x01
#define HOLDING 0x02
#define HELD 0x04

uint16_t ramp_distance(uint16_t speed)
{
    uint16_t distance;

    INTCON &= (uint8_t)~GIEL_MASK;
    ramp_brake_speed = speed;
    ramp_brake();
    distance = ramp_brake_distance;
    INTCON |= GIEL_MASK;
    return distance;
}

uint16_t ramp_cap(uint16_t speed)
{
    while (ramp_distance(speed) > DISTANCE_FAR) {
        speed -= speed >> 4;
    }
    return speed;
}

void ramp_set_stop(void)
{
    ramp_stop = ramp_distance((uint16_t)(ramp_start >> 8));
}

/* The next entry takes what is wanted now, without waiting for its turn; an
   order, during which the tool stands, is waited for. Low interrupt off, on
   behind it. */
static void at_once(void)
{
    ramp_at = NO_ENTRY;
    if (!(stream_next & STREAM_END)) {
        ramp_tick();
    }
    ramp_arm();
    INTCON |= GIEL_MASK;
}

void ramp_set_override(uint8_t percent)
{
    uint16_t scale = (((uint16_t)percent << 7) + 25) / 50;

    INTCON &= (uint8_t)~GIEL_MASK;
    ramp_scale = scale;
    at_once();
}

void ramp_begin(uint8_t segment)
{
    ramp_segment = segment;
    ramp_way = 0;
    path_mark = segments[segment].mark;
    ramp_speed = segment_speed[segment];
    if (ramp_speed > ramp_start) {
        ramp_speed = ramp_start;
    }
    INTCON &= (uint8_t)~GIEL_MASK;
    ramp_set_period();
    ramp_arm();
    INTCON |= GIEL_MASK;
    ramp_flags |= RUNNING;
}

void ramp_end(void)
{
    ramp_flags = 0;
}

void ramp_hold(void)
{
    INTCON &= (uint8_t)~GIEL_MASK;
    ramp_flags |= HOLDING;
    at_once();
}

uint8_t ramp_holding(void)
{
    return ramp_flags & HOLDING;
}

uint8_t ramp_held(void)
{
    return ramp_flags & HELD;
}

void ramp_release(void)
{
    ramp_flags &= (uint8_t) ~(HOLDING | HELD);
    ramp_arm();
}
