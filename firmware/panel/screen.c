/* Texts and numbers on the display.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/screen.h"
#include "arithmetic.h"     /* proportions */
#include "lathe/machine.h"  /* homed or not */
#include "link/protocol.h"  /* axes, settings */
#include "motion/path.h"    /* step queue */
#include "motion/stream.h"  /* positions */
#include "panel/menus.h"    /* the empty text */
#include "panel/lcd.h"      /* panel_screen */
#include "panel/text.h"     /* texts */
#include "store/settings.h" /* part zero, units */

#define DECIMALS 3
#define UM_NM 1000u   /* a thousandth of a millimetre */
#define MIL_NM 25400u /* of an inch */
#define PLACE_Z 25    /* of its letter */

uint8_t screen_negative;
uint8_t screen_point;

void screen_text(uint8_t at, uint8_t number)
{
    path_keep_up();
    text_number = number;
    text_at = at;
    text_room = (at < LINE_2 ? LINE_1_END : LINE_2_END) + 1 - at;
    text_show();
}

void screen_clear(uint8_t at)
{
    screen_text(at, TEXT_ALARM + ALARM_NONE);
}

void screen_number(uint8_t from, uint8_t to)
{
    uint8_t digits = 0;

    do {
        if (screen_point && digits == DECIMALS) {
            panel_screen[to] = '.';
            to--;
        }
        panel_screen[to] = proportion_digit() + '0';
        to--;
        digits++;
    } while (to >= from &&
             (factor_1 != 0 || (screen_point && digits <= DECIMALS)));
    if (screen_negative && to >= from) {
        screen_negative = 0;
        panel_screen[to] = '-';
        to--;
    }
    if (screen_negative || factor_1 != 0) {
        panel_screen[from] = '*';
    }
    while (to >= from) {
        panel_screen[to] = ' ';
        to--;
    }
    screen_negative = 0;
    screen_point = 0;
}

void screen_whole(uint8_t from, uint8_t to, uint16_t value)
{
    path_keep_up();
    factor_1 = value;
    factor_2 = 1;
    divisor = 1;
    (void)proportion();
    screen_number(from, to);
}

uint16_t screen_unit(void)
{
    return settings[SETTING_PANEL_INCH] ? MIL_NM : UM_NM;
}

void screen_position(uint8_t axis)
{
    int16_t steps;
    uint8_t at = LINE_2;
    uint8_t to = PLACE_Z - 1;

    if (!machine_homed) {
        screen_text(LINE_2, TEXT_NOT_HOMED);
        return;
    }
    path_keep_up();
    steps = stream_position(axis) - settings[SETTING_ZERO_X + axis];
    if (steps < 0) {
        screen_negative = 1;
        steps = -steps;
    }
    factor_1 = steps;
    if (axis == AXIS_X) {
        factor_1 *= 2; /* a diameter: up to 64,000 */
    } else {
        at = PLACE_Z;
        to = LINE_2_END;
    }
    factor_2 = settings[SETTING_STEP_X_NM + axis];
    divisor = screen_unit();
    (void)proportion();
    screen_point = 1;
    panel_screen[at] = 'X' + ('Z' - 'X') * axis;
    screen_number(at + 1, to);
}
