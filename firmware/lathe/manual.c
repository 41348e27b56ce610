/* Manual motion: jog, goto, touch.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/manual.h"
#include "config.h"         /* dead man's time */
#include "lathe/guard.h"    /* contact, limits */
#include "lathe/machine.h"  /* states */
#include "lathe/stroke.h"   /* moves */
#include "link/protocol.h"  /* errors, settings */
#include "motion/path.h"    /* end of a move */
#include "motion/ramp.h"    /* dead man */
#include "motion/stream.h"  /* positions */
#include "panel/inputs.h"   /* switches, contact */
#include "store/settings.h" /* travel, rates */
#include "tick.h"           /* dead man's time */

uint8_t manual_contact;

static uint16_t heard_at;
static uint16_t patience; /* ms, 0 for ever */

void manual_heard(void)
{
    heard_at = tick_now();
}

static uint8_t inside(int16_t target, int16_t travel)
{
    return (uint16_t)-target <= (uint16_t)travel;
}

static uint8_t onto_switch(void)
{
    return (stroke_dx > 0 && inputs_state & INPUT_LIMIT_X) ||
           (stroke_dz > 0 && inputs_state & INPUT_LIMIT_Z);
}

static uint8_t begin_touch(void)
{
    if (!settings[SETTING_PROBE_FITTED]) {
        return ERROR_NOT_FITTED;
    }
    if (inputs_state & INPUT_PROBE) {
        return ERROR_PROBE_CLOSED;
    }
    manual_contact = 0;
    stroke_rate = settings[SETTING_LATCH_RATE];
    guard_stop_at(INPUT_PROBE, 1);
    machine_state = STATE_TOUCHING;
    return ERROR_OK;
}

static void begin_moving(void)
{
    uint8_t watched = INPUT_LIMITS;

    if (stroke_rate >> 8) {
        watched |= INPUT_PROBE;
    }
    guard_armed |= watched & (uint8_t)~inputs_state;
    machine_state = STATE_MOVING;
}

uint8_t manual_begin(uint8_t command, int16_t x, int16_t z, uint16_t rate,
                     uint16_t wait)
{
    uint8_t error = machine_not_ready();

    if (error != ERROR_OK) {
        return error;
    }
    stroke_dx = x - stream_position(AXIS_X);
    stroke_dz = z - stream_position(AXIS_Z);
    stroke_rate = rate != 0 ? rate : 0xFFFF;
    if (machine_homed) {
        if (!inside(x, settings[SETTING_TRAVEL_X]) ||
            !inside(z, settings[SETTING_TRAVEL_Z])) {
            return ERROR_OUT_OF_RANGE;
        }
    } else if (command != COMMAND_JOG) {
        return ERROR_NOT_HOMED;
    } else if (onto_switch()) {
        return ERROR_WRONG_WAY;
    } else if (stroke_rate > (uint16_t)settings[SETTING_HOME_RATE]) {
        stroke_rate = settings[SETTING_HOME_RATE];
    }
    if (command != COMMAND_TOUCH) {
        begin_moving();
    } else {
        error = begin_touch();
    }
    if (error == ERROR_OK) {
        patience = wait;
        if (command != COMMAND_JOG) {
            patience = command == COMMAND_TOUCH ? DEADMAN_MS : 0;
        }
        stroke_begin();
    }
    return error;
}

uint8_t manual_poll(void)
{
    if (guard_stopped) {
        manual_contact = STATUS_INPUT_TOUCHED;
        path_cancel();
        return 1;
    }
    if (ramp_holding()) {
        /* A move that has not begun yet does not begin. */
        if (ramp_held() || !(stream_flags & STREAM_ACTIVE)) {
            path_cancel();
        }
    } else if (patience != 0 && tick_now() - heard_at >= patience) {
        ramp_hold();
    }
    /* The flags are read last: a stop may come at any moment. */
    return !path_busy() && !guard_tripped && !guard_stopped;
}
