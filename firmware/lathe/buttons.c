/* What the buttons mean.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/buttons.h"
#include "config.h"        /* long press */
#include "lathe/machine.h" /* actions */
#include "link/protocol.h" /* states, flags */
#include "panel/inputs.h"  /* presses */
#include "panel/led.h"     /* number of the selected part */
#include "store/parts.h"   /* selecting */
#include "tick.h"          /* how long a press lasts */

/* RUN is down: when it is let go it starts the part or resumes it. */
static uint8_t run_down;
static uint16_t run_down_at; /* ms */

void buttons_poll(void)
{
    uint8_t presses = inputs_take_presses();

    if (presses & INPUT_STOP) {
        run_down = 0;
        if (machine_state == STATE_ALARM) {
            machine_reset();
        } else {
            machine_stop();
        }
    } else if (presses & INPUT_HOLD) {
        if (machine_state == STATE_IDLE) {
            led_show(parts_select_next());
        } else {
            machine_hold();
        }
    } else if (presses & INPUT_RUN) {
        if (machine_state == STATE_HOLD || machine_state == STATE_PAUSE) {
            machine_resume();
        } else if (!machine_homed) {
            machine_home(HOMED_ALL);
        } else if (machine_state == STATE_IDLE) {
            run_down = 1;
            run_down_at = tick_now();
        }
    }
    if (run_down && !(inputs_state & INPUT_RUN)) {
        run_down = 0;
        machine_run(SLOT_NONE, tick_now() - run_down_at < LONG_PRESS_MS
                                   ? 0
                                   : RUN_FLAG_RESUME);
    }
}
