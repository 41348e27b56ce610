/* What the settings and homing change in the motion: seldom, and at rest.
   SPDX-License-Identifier: Apache-2.0 */

#include "arithmetic.h"     /* proportion */
#include "link/protocol.h"  /* axes, settings */
#include "motion/entries.h" /* start of a chain */
#include "motion/path.h"    /* dead steps */
#include "motion/plan.h"    /* limits of the axes */
#include "motion/ramp.h"    /* acceleration */
#include "motion/stream.h"  /* positions, coils */
#include "store/settings.h" /* settings */

#define COILS_HALF 2
#define COILS_STEP_DIR 3
#define ENABLE_OUTPUT 0x04

/* ramp_tick.asm. A speed, 1/256 step/s; all but the whole steps stay 0. */
struct speed {
    uint8_t fraction;
    uint16_t whole;
    uint8_t none;
};
extern volatile struct speed ramp_start;
extern volatile struct speed ramp_top; /* that no override exceeds */
extern volatile uint16_t ramp_step;    /* change in 1/1024 s */
extern volatile uint16_t ramp_brake_factor;
extern volatile uint16_t ramp_scale; /* override, 256 = 100 % */

/* The halves of path_rate: byte code has no numbers of 32 bits. */
#define RATE_LOW (*(uint16_t *)&path_rate)
#define RATE_HIGH (*((uint16_t *)&path_rate + 1))

extern volatile uint8_t stream_step_dir;
extern volatile uint8_t stream_invert_x;
extern volatile uint8_t stream_invert_z;
extern volatile uint8_t coils_x[8];
extern volatile uint8_t coils_z[8];
extern volatile uint8_t phase_x;
extern volatile uint8_t phase_z;
extern volatile uint8_t phase_step;

/*
 * Coil patterns in forward order, phase 1 = bit 0. Even entries have two
 * phases on, odd ones one: every second entry from an even place is the full
 * step sequence 5, 9, 10, 6, from an odd place the wave sequence 1, 8, 2, 4,
 * and all eight are half steps.
 */
static __code const uint8_t forward[8] = {5, 1, 9, 8, 10, 2, 6, 4};

static uint16_t smaller_setting(uint8_t one, uint8_t other)
{
    return settings[one] < settings[other] ? settings[one] : settings[other];
}

/* 2^24 / acceleration, step/s^2, 1,100..32,000: for braking distances. */
static uint16_t brake_factor(uint16_t acceleration)
{
    factor_1 = 4096;
    factor_2 = 4096;
    divisor = acceleration;
    return proportion();
}

void path_configure(void)
{
    uint16_t acceleration = settings[SETTING_ACCELERATION];

    ramp_start.whole =
        smaller_setting(SETTING_START_RATE_X, SETTING_START_RATE_Z);
    ramp_step = acceleration >> 2;
    ramp_brake_factor = brake_factor(acceleration);
    ramp_top.whole =
        ramp_cap(smaller_setting(SETTING_RAPID_RATE_X, SETTING_RAPID_RATE_Z));
    ramp_scale = 256;
    ramp_set_stop();
    plan_start_x = settings[SETTING_START_RATE_X];
    plan_start_z = settings[SETTING_START_RATE_Z];
    plan_maximum_x = ramp_cap(settings[SETTING_RAPID_RATE_X]);
    plan_maximum_z = ramp_cap(settings[SETTING_RAPID_RATE_Z]);
}

void path_set_feed(uint16_t feed)
{
    RATE_LOW = feed << 5; /* 256 / FEED_UNIT */
    RATE_HIGH = feed >> 11;
}

void path_set_rapid(uint16_t rate)
{
    RATE_LOW = rate << 8;
    RATE_HIGH = rate >> 8;
}

void path_begin(void)
{
    path_head = 0;
    path_made = 0;
    ramp_segment = 0;
    path_complete = 0;
    path_refused = 0;
    path_ended = 0;
    path_started = 0;
    path_begun = 0;
    entries_made = 0;
    entries_run_left = 0;
    entries_run_kind = 0;
    entries_due_x = 0;
    entries_due_z = 0;
    entries_waiting = 0;
    entries_planned_slack_x = slack_x; /* as the step stream tells */
    entries_planned_slack_z = slack_z;
    plan_begin();
    ramp_end();
    stream_prepare();
}

void stream_set_coils(uint8_t mode, uint8_t invert_x, uint8_t invert_z)
{
    uint8_t i;

    for (i = 0; i < 8; i++) {
        uint8_t backward = (8 - i) & 7;

        coils_x[i] = forward[invert_x ? backward : i];
        coils_z[i] = forward[invert_z ? backward : i];
        if (mode == COILS_STEP_DIR) {
            coils_x[i] = ENABLE_OUTPUT;
            coils_z[i] = ENABLE_OUTPUT;
        }
    }
    stream_step_dir = mode == COILS_STEP_DIR;
    stream_invert_x = invert_x << 1;
    stream_invert_z = invert_z << 1;
    phase_step = mode == COILS_HALF ? 1 : 2;
    if (mode < COILS_HALF) {
        phase_x = (phase_x & 6) | mode;
        phase_z = (phase_z & 6) | mode;
    }
}

void path_set_home(uint8_t axis)
{
    if (axis == AXIS_X) {
        position_x = 0;
        slack_x = -(int16_t)motion_dead_x;
    } else {
        position_z = 0;
        slack_z = -(int16_t)motion_dead_z;
    }
}
