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

#define REPEATS_MAX 9

#define COILS_STEP_DIR 3

uint8_t homing_axis;
uint8_t homing_axes;
uint8_t homing_spread[2];
uint8_t homing_warnings;

extern volatile uint8_t phase_x;
extern volatile uint8_t phase_z;

static uint8_t known; /* axes whose position was trusted */
static uint8_t phase;
static int16_t start; /* position at the start of the phase */
static uint16_t counts[REPEATS_MAX];
static uint8_t repeat;
static uint8_t others_before; /* other switches pressed at the start */
static int16_t before;        /* a setting before it was stored anew */

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

/* Furthest the screw may have to turn before the switch opens again. */
static int16_t release_limit(void)
{
    return settings[SETTING_DEAD_MAX] + 1 +
           settings[SETTING_SWITCH_TRAVEL_X + homing_axis];
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
    /* Every step counts as a tool step until the dead steps are known; the
       screw is at 0 where the switch opened last time. */
    if (axis == AXIS_X) {
        position_x += slack_x;
        position_x += motion_dead_x;
        motion_dead_x = 0;
        slack_x = 0;
    } else {
        position_z += slack_z;
        position_z += motion_dead_z;
        motion_dead_z = 0;
        slack_z = 0;
    }
    if (pressed()) {
        leave();
        return;
    }
    seek(PHASE_SEEK, settings[SETTING_TRAVEL_X + axis] + HOMING_MARGIN_STEPS,
         settings[SETTING_HOME_RATE], 1);
}

void homing_begin(uint8_t axes, uint8_t known_axes)
{
    homing_axes = axes;
    known = known_axes;
    begin_axis(axes & HOMED_AXIS_X ? AXIS_X : AXIS_Z);
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

static uint16_t size(int16_t value)
{
    return value < 0 ? -value : value;
}

/* The bit of the axis: HOMED_AXIS_..., WARNING_... */
static uint8_t axis_bit(void)
{
    return homing_axis + 1;
}

/* Stores a setting of the axis; what it was before is in `before`. */
static void store(uint8_t id, int16_t value)
{
    id += homing_axis;
    before = settings[id];
    settings_set(id, value);
}

/* True when the screw does not stand where it stood in the homing before. */
static uint8_t drifted(void)
{
    int16_t drift = position();
    uint8_t turn = homing_axis == AXIS_X ? phase_x : phase_z;

    store(SETTING_HOME_PHASE_X, turn);
    if (!(known & axis_bit())) {
        drift = 0;
        if (before >= 0 && settings[SETTING_COIL_MODE] != COILS_STEP_DIR) {
            turn = (turn - (uint8_t)before) & 7; /* half steps */
            drift = (turn > 4 ? 8 - turn : turn) >> 1;
        }
    }
    return size(drift) > (uint16_t)settings[SETTING_DRIFT_MAX];
}

/* Takes the median as the axis's dead steps. Returns an alarm or 0. */
static uint8_t conclude(void)
{
    int16_t count;
    uint8_t moved;

    sort_counts();
    count = counts[repeat - 1] - counts[0];
    homing_spread[homing_axis] = count > 255 ? 255 : (uint8_t)count;
    if (count > settings[SETTING_SPREAD_MAX]) {
        return ALARM_DEAD_STEPS_SPREAD;
    }
    count = counts[repeat >> 1] - 1 -
            settings[SETTING_SWITCH_TRAVEL_X + homing_axis];
    if (count < 0) {
        count = 0;
    }
    if (homing_axis == AXIS_X) {
        motion_dead_x = count;
    } else {
        motion_dead_z = count;
    }
    store(SETTING_DEAD_X, count);
    homing_warnings &= (uint8_t)~axis_bit();
    if (before >= 0 &&
        size(before - count) > (uint16_t)settings[SETTING_DEAD_JUMP]) {
        homing_warnings |= axis_bit();
    }
    moved = drifted();
    path_set_home(homing_axis);
    if (moved) {
        return ALARM_PHASE_DRIFT;
    }
    seek(PHASE_PARK, -PARK_STEPS, settings[SETTING_HOME_RATE], 0);
    guard_stop_at(0, 0);
    return 0;
}

static void latch(void)
{
    seek(PHASE_LATCH, release_limit() + HOMING_MARGIN_STEPS,
         settings[SETTING_LATCH_RATE], 1);
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
        latch();
        return 0;
    case PHASE_LATCH:
        if (!found) {
            return ALARM_HOME_NOT_FOUND;
        }
        seek(PHASE_COUNT, -release_limit() - LATE_MARGIN_STEPS,
             settings[SETTING_LATCH_RATE], 0);
        return 0;
    case PHASE_COUNT:
        if (!found) {
            return ALARM_HOME_NOT_RELEASED;
        }
        counts[repeat] = (uint16_t)(start - position());
        if ((int16_t)counts[repeat] > release_limit()) {
            return ALARM_HOME_OPENED_LATE;
        }
        repeat++;
        if (repeat == (uint8_t)settings[SETTING_HOMING_REPEATS]) {
            return conclude();
        }
        latch();
        return 0;
    default:
        if (homing_axis == AXIS_X && (homing_axes & HOMED_AXIS_Z)) {
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
