/*
 * Numbers of the firmware that are chosen, not measured: each with unit,
 * range and reason. A value out of range does not compile.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * What a user may change at the machine is a setting (link/protocol.toml).
 */
#ifndef CONFIG_H
#define CONFIG_H

/* Rest before an axis turns back, ms. Range 1..80. Long enough for a rotor of
   this size to stop swinging after a step at its start/stop speed. */
#define REST_MS 10
#if REST_MS < 1 || REST_MS > 80
#error "REST_MS must be 1 to 80 ms"
#endif

/* Where homing leaves the axes, steps from the switch. Range 1..200: enough
   that interference or heat does not close the switch again. */
#define PARK_STEPS 20
#if PARK_STEPS < 1 || PARK_STEPS > 200
#error "PARK_STEPS must be 1 to 200"
#endif

/* Shortest step pulse, us: what the step interrupt takes anyway. */
#define PULSE_LEAST_US 5

/* Longer than the input filter takes (panel/inputs.h), ms: rest after a
   move, so that the filter has seen its last step. */
#define FILTER_MS 6

/* A jog ends when the host is not heard for so long, ms. Range 300..5000:
   longer than the host takes to repeat a lost request, 250 ms. */
#define DEADMAN_MS 500u
#if DEADMAN_MS < 300 || DEADMAN_MS > 5000
#error "DEADMAN_MS must be 300 to 5000"
#endif

/* A limit switch that closes farther than this from its end is a fault of its
   wire, steps. Range 50..2000: more than lost steps explain. */
#define SWITCH_NEAR_STEPS 400
#if SWITCH_NEAR_STEPS < 50 || SWITCH_NEAR_STEPS > 2000
#error "SWITCH_NEAR_STEPS must be 50 to 2000"
#endif

/* Fast approach gives up after the travel and this many steps more. */
#define HOMING_MARGIN_STEPS 400

/* How far homing goes on to tell a switch that opens too late from one that
   does not open, steps. Range 10..500. */
#define LATE_MARGIN_STEPS 60
#if LATE_MARGIN_STEPS < 10 || LATE_MARGIN_STEPS > 500
#error "LATE_MARGIN_STEPS must be 10 to 500"
#endif

/* RUN held down for so long resumes a part, ms. Range 500..5000: longer than
   anybody presses a button by habit. */
#define LONG_PRESS_MS 1500
#if LONG_PRESS_MS < 500 || LONG_PRESS_MS > 5000
#error "LONG_PRESS_MS must be 500 to 5000 ms"
#endif

#endif
