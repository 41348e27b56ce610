/* Switches and buttons, sampled every millisecond.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/inputs.h"
#include "board.h"          /* masks */
#include "link/protocol.h"  /* settings */
#include "sfr.h"            /* ports */
#include "store/settings.h" /* probe fitted */

volatile uint8_t inputs_state;

static uint8_t first; /* reading of this millisecond */
static uint8_t lead_low;
static uint8_t lead_high;
static uint8_t seen; /* state at the last inputs_take_presses() */

static uint8_t raw_levels(void)
{
    uint8_t b = PORTB;
    uint8_t d = PORTD;
    uint8_t raw = 0;

    if (b & LIMIT_X_MASK) {
        raw |= INPUT_LIMIT_X;
    }
    if (b & LIMIT_Z_MASK) {
        raw |= INPUT_LIMIT_Z;
    }
    if (d & ESTOP_SENSE_MASK) {
        raw |= INPUT_ESTOP;
    }
    if (!(d & BUTTON_RUN_MASK)) {
        raw |= INPUT_RUN;
    }
    if (!(d & BUTTON_HOLD_MASK)) {
        raw |= INPUT_HOLD;
    }
    if (!(d & BUTTON_STOP_MASK)) {
        raw |= INPUT_STOP;
    }
    if (settings[SETTING_PROBE_FITTED] && !(PORTA & PROBE_MASK)) {
        raw |= INPUT_PROBE;
    }
    return raw;
}

void inputs_init(void)
{
    inputs_state = raw_levels();
    seen = inputs_state;
}

void inputs_read(void)
{
    first = raw_levels();
}

void inputs_tick(void)
{
    uint8_t changed = raw_levels() ^ inputs_state;
    uint8_t count;
    uint8_t flips;

    changed &= first ^ inputs_state;
    count = changed | lead_low | lead_high;
    flips = changed & lead_low & lead_high;
    lead_high ^= count & (uint8_t) ~(changed ^ lead_low);
    lead_low ^= count;
    inputs_state ^= flips;
}

uint8_t inputs_take_presses(void)
{
    uint8_t now = inputs_state;
    uint8_t presses = now & (uint8_t)~seen;

    seen = now;
    return presses;
}
