/* Status LED patterns.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/led.h"
#include "lathe/machine.h" /* state, alarm */
#include "link/protocol.h" /* STATE_..., ALARM_NONE */
#include "tick.h"          /* tick_now */

#define STARTUP_MS 2000
#define FLASH_MS 256 /* one flash of an alarm code and one gap */
#define PAUSE_FLASHES 6

static uint8_t started; /* the start-up light is over */
static uint16_t code_began;

static uint8_t number; /* to be flashed once */

void led_show(uint8_t flashes)
{
    number = flashes;
    code_began = tick_now();
}

/* So many flashes and a pause, again and again. */
static uint8_t code_lit(uint16_t now, uint8_t flashes)
{
    uint16_t elapsed = now - code_began;
    uint8_t half = (uint8_t)(elapsed / (FLASH_MS / 2));
    uint8_t flash = half >> 1;

    if (flash >= flashes + PAUSE_FLASHES) {
        code_began = now;
        number = 0;
    }
    return flash < flashes && !(half & 1);
}

void led_poll(void)
{
    uint16_t now = tick_now();
    uint8_t lit;

    if (!started && now < STARTUP_MS) {
        lit = 1;
    } else {
        started = 1;
        switch (machine_state) {
        case STATE_IDLE:
            if (number != 0) {
                lit = code_lit(now, number);
                break;
            }
            lit = machine_homed || (now & 0x200);
            break;
        case STATE_HOLD:
        case STATE_PAUSE:
            lit = (now & 0x80) != 0;
            break;
        case STATE_ALARM:
            lit = code_lit(now, machine_alarm);
            break;
        default:
            lit = (now & 0x1C0) != 0;
            break;
        }
    }
    if (lit) {
        led_on();
    } else {
        led_off();
    }
}
