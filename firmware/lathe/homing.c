/* Homing and dead steps.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/homing.h"
#include "config.h"         /* margins */
#include "lathe/guard.h"    /* stops the stream at a switch */
#include "lathe/stroke.h"   /* moves */
#include "link/protocol.h"  /* alarms, axes, settings */
#include "motion/path.h"    /* moves */
#include "motion/stream.h"  /* positions */
#include "panel/inputs.h"   /* switches */
#include "store/settings.h" /* rates, repeats */

enum phase { PHASE_SEEK, PHASE_LEAVE, PHASE_LATCH, PHASE_COUNT, PHASE_PARK };

/* The input filter needs 4 ms; at this rate a step lasts 10 ms. */
#define LATCH_RATE_MAX 100

#define REPEATS_MAX 9

uint8_t homing_axis;

static uint8_t phase;
static int16_t start; /* position at the start of the phase */
static uint16_t counts[REPEATS_MAX];
static uint8_t repeat;
static uint8_t others_before; /* other switches pressed at the start */

static uint8_t own_switch(void)
{
    return homing_axis == AXIS_X ? INPUT_LIMIT_X : INPUT_LIMIT_Z;
}

static uint8_t other_switches(void)
{
    return inputs_state & INPUT_LIMITS & (uint8_t)~own_switch();
}

static uint8_t pressed(void)
{
    return inputs_state & own_switch();
}

static int16_t position(void)
{
    return stream_position(homing_axis);
}

/* Moves by a distance until the switch is pressed (1) or open (0). */
static void seek(uint8_t next, int16_t distance, int16_t steps_per_second,
                 uint8_t until_pressed)
{
    phase = next;
    start = position();
    stroke_rate = steps_per_second;
    guard_stop_at(own_switch(), until_pressed);
    stroke_along(homing_axis, distance);
}

static int16_t latch_rate(void)
{
    int16_t wanted = settings[SETTING_LATCH_RATE];

    return wanted > LATCH_RATE_MAX ? LATCH_RATE_MAX : wanted;
}

/* Furthest the screw may have to turn before the switch opens again. */
static int16_t release_limit(void)
{
    return settings[SETTING_DEAD_MAX] + 1 +
           settings[homing_axis == AXIS_X ? SETTING_SWITCH_TRAVEL_X
                                          : SETTING_SWITCH_TRAVEL_Z];
}

static void leave(void)
{
    seek(PHASE_LEAVE, -release_limit() - HOMING_MARGIN_STEPS,
         settings[SETTING_HOME_RATE], 0);
}

static void begin_axis(uint8_t axis)
{
    homing_axis = axis;
    repeat = 0;
    others_before = other_switches();
    /* Every step counts as a tool step until the dead steps are known. */
    if (axis == AXIS_X) {
        motion_dead_x = 0;
        slack_x = 0;
    } else {
        motion_dead_z = 0;
        slack_z = 0;
    }
    if (pressed()) {
        leave();
        return;
    }
    seek(PHASE_SEEK,
         settings[axis == AXIS_X ? SETTING_TRAVEL_X : SETTING_TRAVEL_Z] +
             HOMING_MARGIN_STEPS,
         settings[SETTING_HOME_RATE], 1);
}

void homing_begin(void)
{
    begin_axis(AXIS_X);
}

/* Sorts the counts: at most nine. */
static void sort_counts(void)
{
    uint8_t sorted;
    uint8_t i;

    for (sorted = 1; sorted < repeat; sorted++) {
        uint16_t value = counts[sorted];

        for (i = sorted; i > 0 && counts[i - 1] > value; i--) {
            counts[i] = counts[i - 1];
        }
        counts[i] = value;
    }
}

/* Takes the median as the axis's dead steps. Returns an alarm or 0. */
static uint8_t conclude(void)
{
    uint8_t x = homing_axis == AXIS_X;
    uint16_t travel = (uint16_t)
        settings[x ? SETTING_SWITCH_TRAVEL_X : SETTING_SWITCH_TRAVEL_Z];
    uint16_t count;

    sort_counts();
    if (counts[repeat - 1] - counts[0] >
        (uint16_t)settings[SETTING_SPREAD_MAX]) {
        return ALARM_DEAD_STEPS_SPREAD;
    }
    count = counts[repeat >> 1];
    count = count > travel ? count - 1 - travel : 0;
    if (x) {
        motion_dead_x = count;
    } else {
        motion_dead_z = count;
    }
    settings[x ? SETTING_DEAD_X : SETTING_DEAD_Z] = count;
    path_set_home(homing_axis);
    seek(PHASE_PARK, -PARK_STEPS, settings[SETTING_HOME_RATE], 0);
    guard_stop_at(0, 0);
    return 0;
}

/* The move of the present phase has ended: at the switch (1) or not (0). */
static uint8_t next_phase(uint8_t found)
{
    switch (phase) {
    case PHASE_SEEK:
        if (!found) {
            return ALARM_HOME_NOT_FOUND;
        }
        leave();
        return 0;
    case PHASE_LEAVE:
        if (!found) {
            return ALARM_HOME_NOT_RELEASED;
        }
        seek(PHASE_LATCH, release_limit() + HOMING_MARGIN_STEPS, latch_rate(),
             1);
        return 0;
    case PHASE_LATCH:
        if (!found) {
            return ALARM_HOME_NOT_FOUND;
        }
        seek(PHASE_COUNT, -release_limit(), latch_rate(), 0);
        return 0;
    case PHASE_COUNT:
        if (!found) {
            return ALARM_HOME_NOT_RELEASED;
        }
        counts[repeat] = (uint16_t)(start - position());
        repeat++;
        if (repeat == (uint8_t)settings[SETTING_HOMING_REPEATS]) {
            return conclude();
        }
        seek(PHASE_LATCH, release_limit() + HOMING_MARGIN_STEPS, latch_rate(),
             1);
        return 0;
    default:
        if (homing_axis == AXIS_X) {
            begin_axis(AXIS_Z);
            return 0;
        }
        return HOMING_DONE;
    }
}

uint8_t homing_poll(void)
{
    if (other_switches() & (uint8_t)~others_before) {
        return ALARM_WRONG_SWITCH;
    }
    if (guard_stopped) {
        path_cancel();
        return next_phase(1);
    }
    /* The flag is read last: the switch may end the motion at any moment. */
    if (!path_busy() && !guard_stopped) {
        return next_phase(0);
    }
    return 0;
}
