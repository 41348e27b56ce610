/* The machine's states and events.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/machine.h"
#include "arithmetic.h"       /* proportions */
#include "config.h"           /* shortest pulse */
#include "lathe/buttons.h"    /* what they mean */
#include "lathe/guard.h"      /* trips */
#include "lathe/homing.h"     /* homing phases */
#include "lathe/manual.h"     /* jog, goto, touch */
#include "lathe/part.h"       /* number of operations */
#include "lathe/part_check.h" /* before every run */
#include "lathe/passes.h"     /* moves of a part */
#include "lathe/progress.h"   /* resuming */
#include "lathe/stroke.h"     /* moves of homing and by hand */
#include "link/protocol.h"    /* states, alarms, errors */
#include "motion/path.h"      /* chains */
#include "motion/ramp.h"      /* hold */
#include "motion/stream.h"    /* freeze, positions */
#include "panel/inputs.h"     /* buttons */
#include "store/parts.h"      /* selected part */
#include "store/settings.h"   /* settings */
#include "tick.h"             /* idle time */

uint8_t machine_state;
uint8_t machine_alarm;
uint8_t machine_alarm_detail;
uint8_t machine_homed;
uint8_t machine_homed_axes;
uint8_t machine_slot;

static uint8_t finished;  /* the last run came to its end */
static uint16_t moved_at; /* when something last moved, ms */

static void arm(void)
{
    uint8_t inputs = 0;

    if (settings[SETTING_ESTOP_FITTED]) {
        inputs |= INPUT_ESTOP;
    }
    if (machine_homed) {
        inputs |= INPUT_LIMITS;
    }
    guard_armed = inputs;
}

static void set_homed(uint8_t axes)
{
    machine_homed_axes = axes;
    machine_homed = axes == HOMED_ALL;
    arm();
}

static void raise(uint8_t alarm, uint8_t detail)
{
    path_cancel();
    guard_stop_at(0, 0);
    machine_alarm = alarm;
    machine_alarm_detail = detail;
    machine_state = STATE_ALARM;
    set_homed(0);
}

void machine_apply_settings(void)
{
    path_configure();
    stream_pulse = (uint8_t)(settings[SETTING_PULSE_US] - PULSE_LEAST_US) << 2;
    stream_set_coils((uint8_t)settings[SETTING_COIL_MODE],
                     (uint8_t)settings[SETTING_INVERT_X],
                     (uint8_t)settings[SETTING_INVERT_Z]);
    arm();
}

void machine_init(void)
{
    uint8_t settings_good = settings_load();

    path_cancel();
    machine_slot = SLOT_NONE;
    progress_init();
    machine_apply_settings();
    if (!settings_good) {
        raise(ALARM_SETTINGS_LOST, 0);
    }
}

uint8_t machine_quiet(void)
{
    return machine_state == STATE_IDLE || machine_state == STATE_ALARM;
}

uint8_t machine_not_ready(void)
{
    if (machine_state == STATE_ALARM) {
        return ERROR_ALARM;
    }
    if (machine_state != STATE_IDLE) {
        return ERROR_BUSY;
    }
    return ERROR_OK;
}

uint8_t machine_home(uint8_t axes)
{
    uint8_t error = machine_not_ready();

    if ((uint8_t)(axes - 1) >= HOMED_ALL) {
        return ERROR_OUT_OF_RANGE;
    }
    if (error == ERROR_OK) {
        machine_state = STATE_HOMING;
        homing_begin(axes, machine_homed_axes);
        set_homed(machine_homed_axes & (uint8_t)~axes);
    }
    return error;
}

uint8_t machine_run(uint8_t slot, uint8_t flags)
{
    uint8_t error = machine_not_ready();
    uint8_t from = 1;

    if (error != ERROR_OK) {
        return error;
    }
    if (!machine_homed) {
        return ERROR_NOT_HOMED;
    }
    if (flags & RUN_FLAG_RESUME) {
        slot = progress_slot();
        if (slot == SLOT_NONE) {
            return ERROR_NOTHING_TO_RESUME;
        }
    } else if (slot == SLOT_NONE) {
        slot = parts_selected();
    }
    if (!parts_present(slot)) {
        return ERROR_NO_PART;
    }
    if (!parts_intact(slot)) {
        return ERROR_CRC_MISMATCH;
    }
    if (part_check(slot, parts_length)) {
        return ERROR_INVALID_PART;
    }
    if (flags & RUN_FLAG_RESUME) {
        from = progress_from();
    } else {
        progress_forget();
    }
    progress_follow(from);
    machine_slot = slot;
    machine_state = STATE_RUNNING;
    finished = 0;
    ramp_set_override(100);
    passes_begin(slot, flags & RUN_FLAG_STEP, from);
    path_begin();
    return ERROR_OK;
}

uint8_t machine_hold(void)
{
    if (machine_state == STATE_HOLD) {
        return ERROR_OK;
    }
    if (machine_state == STATE_RUNNING) {
        machine_state = STATE_HOLD;
    } else if (machine_state != STATE_MOVING) {
        return ERROR_NOT_RUNNING;
    }
    ramp_hold();
    return ERROR_OK;
}

uint8_t machine_resume(void)
{
    if (machine_state == STATE_RUNNING) {
        return ERROR_OK;
    }
    if (machine_state == STATE_PAUSE) {
        machine_state = STATE_RUNNING;
        path_begin();
        return ERROR_OK;
    }
    if (machine_state != STATE_HOLD) {
        return ERROR_NOT_RUNNING;
    }
    machine_state = STATE_RUNNING;
    if (ramp_held()) {
        ramp_release();
        stream_thaw();
    }
    ramp_release();
    return ERROR_OK;
}

uint8_t machine_override(uint8_t percent)
{
    if (percent < OVERRIDE_MIN || percent > OVERRIDE_MAX) {
        return ERROR_OUT_OF_RANGE;
    }
    if (!machine_running()) {
        return ERROR_NOT_RUNNING;
    }
    ramp_set_override(percent);
    return ERROR_OK;
}

static void become_idle(void)
{
    machine_state = STATE_IDLE;
    guard_stop_at(0, 0);
    arm();
}

uint8_t machine_stop(void)
{
    if (machine_state == STATE_HOMING) {
        raise(ALARM_STOPPED_HOMING, homing_axis);
    } else if (!machine_quiet()) {
        path_cancel();
        become_idle();
    }
    return ERROR_OK;
}

uint8_t machine_reset(void)
{
    if (machine_state != STATE_ALARM) {
        return ERROR_OK;
    }
    if (guard_armed & inputs_state & INPUT_ESTOP) {
        return ERROR_ESTOP;
    }
    guard_clear();
    if (machine_alarm == ALARM_SETTINGS_LOST) {
        settings_save();
    }
    machine_state = STATE_IDLE;
    machine_alarm = ALARM_NONE;
    machine_alarm_detail = 0;
    return ERROR_OK;
}

uint8_t machine_zero(uint8_t axis, int16_t value)
{
    int16_t zero;

    if (!machine_quiet()) {
        return ERROR_BUSY;
    }
    if (!machine_homed) {
        return ERROR_NOT_HOMED;
    }
    if (axis > AXIS_Z || value > POSITION_MAX || value < -POSITION_MAX) {
        return ERROR_OUT_OF_RANGE;
    }
    zero = stream_position(axis);
    return settings_set(axis == AXIS_X ? SETTING_ZERO_X : SETTING_ZERO_Z,
                        zero - value);
}

uint8_t machine_set(uint8_t id, int16_t value)
{
    uint8_t error;

    if (!machine_quiet()) {
        return ERROR_BUSY;
    }
    error = settings_set(id, value);
    machine_apply_settings();
    return error;
}

uint8_t machine_running(void)
{
    return machine_state == STATE_RUNNING || machine_state == STATE_HOLD ||
           machine_state == STATE_PAUSE;
}

uint16_t machine_permille(void)
{
    uint16_t permille;
    uint16_t one; /* operation */
    uint8_t done;

    if (finished) {
        return PERMILLE_DONE;
    }
    if (!machine_running()) {
        return 0;
    }
    done = passes_operation();
    if (done == 0) {
        return 0;
    }
    one = (uint16_t)PERMILLE_DONE / part_operations;
    permille = (uint16_t)(done - 1) * one;
    factor_1 = one;
    factor_2 = passes_pass();
    divisor = passes_passes(); /* 0: not known, but not fewer than done */
    if (divisor == 0) {
        divisor = factor_2;
    }
    divisor++;
    return permille + proportion();
}

static void serve_limit(uint8_t axis)
{
    raise(machine_homed && stream_position(axis) < -SWITCH_NEAR_STEPS
              ? ALARM_SWITCH_WIRING
              : ALARM_LIMIT,
          axis);
}

/* Names the alarm for what the guard has stopped. */
static void serve_trip(void)
{
    if (guard_tripped & INPUT_ESTOP) {
        raise(ALARM_ESTOP, 0);
    } else if (guard_tripped & INPUT_LIMIT_X) {
        serve_limit(AXIS_X);
    } else if (guard_tripped & INPUT_LIMIT_Z) {
        serve_limit(AXIS_Z);
    } else if (guard_tripped & INPUT_PROBE) {
        raise(ALARM_PROBE_UNEXPECTED, 0);
    } else {
        raise(ALARM_STREAM_DRY, 0);
    }
    guard_tripped = 0;
}

static void serve_homing(void)
{
    uint8_t result = homing_poll();

    if (result == HOMING_DONE) {
        set_homed(machine_homed_axes | homing_axes);
        become_idle();
    } else if (result != 0) {
        raise(result, homing_axis);
    }
}

/* Current off the coils, some time after the last move. A lathe's screw does
   not turn by itself, so the position stays trusted. */
static void serve_idle(void)
{
    int16_t idle = settings[SETTING_IDLE_MS];

    if (machine_quiet() && idle >= 0 &&
        tick_now() - moved_at >= (uint16_t)idle) {
        stream_coils_off();
        moved_at = tick_now() - (uint16_t)idle;
    }
}

void machine_poll(void)
{
    serve_idle();
    if (guard_tripped) {
        serve_trip();
    }
    buttons_poll();
    if (machine_state == STATE_HOMING) {
        serve_homing();
    } else if (machine_state >= STATE_MOVING) {
        if (manual_poll()) {
            become_idle();
        }
    } else if ((machine_state == STATE_RUNNING ||
                machine_state == STATE_HOLD) &&
               !path_busy() && !guard_tripped) {
        /* The flag is read last: a trip may end the motion at any moment. */
        if (passes_more) {
            machine_state = STATE_PAUSE;
        } else {
            progress_forget();
            finished = 1;
            become_idle();
        }
    }
    progress_poll(machine_state == STATE_RUNNING);
    if (path_refused && !machine_quiet()) {
        raise(ALARM_PATH, 0);
    }
    if (!machine_quiet()) {
        moved_at = tick_now();
    }
}

uint8_t path_source(void)
{
    return machine_running() ? passes_source() : stroke_source();
}
