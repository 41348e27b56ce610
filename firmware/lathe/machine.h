/*
 * The machine: which state it is in and what every event does to it.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * The whole table of states and events, with every command, is states.toml
 * beside this file; docs/states.md shows it, and a test walks it.
 *
 * RUN and STOP are buttons; the commands HOME, RUN and RESUME are the three
 * meanings of the first, STOP and RESET those of the second; JOG and GOTO
 * lead from IDLE to MOVING, TOUCH to TOUCHING (lathe/manual.h). A homed machine
 * in IDLE waits until RUN is let go: it starts the part, or resumes it when
 * RUN was down for LONG_PRESS_MS. HOLD in IDLE
 * selects the next part; the LED flashes its number. In PAUSE the slides are
 * parked and the part waits for a person: a message, another tool, or the end
 * of an operation when it is run step by step. A trip is the
 * emergency stop, a limit switch while homed or MOVING, the contact sensor in
 * a fast move, or a step stream that ran dry; it makes the position
 * untrusted. A limit switch that closes far from its end is told as a fault
 * of its wire (SWITCH_NEAR_STEPS). ALARM ends by the command RESET or the
 * STOP button, when its cause is gone; then IDLE, not homed. Acknowledging
 * SETTINGS_LOST stores the defaults.
 *
 * Main loop only. Functions that return a number return ERROR_OK or the
 * ERROR_... that says why not; then nothing has changed.
 */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdint.h>

extern uint8_t machine_state;        /* STATE_... */
extern uint8_t machine_alarm;        /* ALARM_... */
extern uint8_t machine_alarm_detail; /* axis, where one is concerned */
extern uint8_t machine_homed;        /* both axes */
extern uint8_t machine_homed_axes;   /* HOMED_AXIS_... */
#define HOMED_ALL (HOMED_AXIS_X | HOMED_AXIS_Z)
extern uint8_t machine_slot; /* part being cut or cut last, SLOT_NONE */

/* Starts in IDLE, or in ALARM when the settings were lost. */
void machine_init(void);

/* Serves trips, buttons, and what moves; every 4 ms, and a
   millisecond after an input has changed. */
void machine_poll(void);

/* axes: HOMED_AXIS_... */
uint8_t machine_home(uint8_t axes);
/* flags: RUN_FLAG_... */
uint8_t machine_run(uint8_t slot, uint8_t flags);
uint8_t machine_hold(void);
uint8_t machine_resume(void);
uint8_t machine_stop(void);
uint8_t machine_reset(void);

/* Feed of the run under way, percent, 10..200. */
uint8_t machine_override(uint8_t percent);

/* Why no motion can start now, or ERROR_OK. */
uint8_t machine_not_ready(void);

/* True when flash and settings may be written: nothing moves or could. */
uint8_t machine_quiet(void);

/* The tool stands at this part coordinate: moves and stores part zero. */
uint8_t machine_zero(uint8_t axis, int16_t value);

/* Changes a setting, stores all, and takes them into use. */
uint8_t machine_set(uint8_t id, int16_t value);

/* Takes settings that motion depends on into use. */
void machine_apply_settings(void);

/* A part has been begun and is not complete. */
uint8_t machine_running(void);

/* Progress of the run, 0..1000. */
uint16_t machine_permille(void);

#endif
