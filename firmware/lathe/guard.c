/* Guard: stops the motors within a millisecond.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/guard.h"
#include "motion/stream.h" /* abort, coils */
#include "panel/inputs.h"  /* filtered inputs */

volatile uint8_t guard_tripped;
volatile uint8_t guard_stopped;
volatile uint8_t guard_armed;

volatile uint8_t guard_stop_input;
volatile uint8_t guard_stop_inverted;

void guard_clear(void)
{
    guard_tripped = 0;
    stream_flags &= (uint8_t)~STREAM_DRY;
}

void guard_tick(void)
{
    uint8_t tripped = inputs_state & guard_armed;

    if (stream_flags & STREAM_DRY) {
        tripped |= GUARD_DRY;
    }
    if (tripped) {
        /* Again in every tick: the main loop may just have been pushing. */
        stream_abort();
        if (tripped & INPUT_ESTOP) {
            stream_coils_off();
        }
        guard_tripped |= tripped;
    }
    if ((inputs_state ^ guard_stop_inverted) & guard_stop_input) {
        stream_abort();
        guard_stopped = 1;
    }
}
