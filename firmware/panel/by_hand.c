/* Jog, touch, part zero by the keys.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/by_hand.h"
#include "arithmetic.h"     /* proportions */
#include "lathe/machine.h"  /* state, part zero */
#include "lathe/manual.h"   /* moves */
#include "link/protocol.h"  /* commands, errors */
#include "motion/stream.h"  /* positions */
#include "panel/keys.h"     /* key let go */
#include "panel/ladder.h"   /* keys */
#include "panel/menus.h"    /* texts */
#include "panel/screen.h"   /* unit */
#include "store/settings.h" /* travel, part zero */

/* How far a touch goes without contact, and a jog before the first homing
   while a key is held, steps. */
#define TOUCH_STEPS 1000
#define JOG_STEPS 15000

/* No diameter of this many thousandths of an inch makes more than 16 bits of
   steps. */
#define DIAMETER_MAX_MIL 9999u

uint8_t by_hand_choice[2];
uint16_t by_hand_diameter;

static uint8_t jogging;  /* as long as this key is held: number + 1, else 0 */
static uint8_t touching; /* begun here: axis + 1, else 0 */

static __code const uint16_t rates[CHOICES] = {0, 400, 100, 25};
static __code const uint16_t distances[CHOICES] = {10, 100, 1000, 0};

uint16_t by_hand_rate(void)
{
    return rates[by_hand_choice[CHOICE_SPEED]];
}

uint16_t by_hand_distance(void)
{
    uint16_t distance = distances[by_hand_choice[CHOICE_SIZE]];

    return settings[SETTING_PANEL_INCH] ? distance / 10 : distance;
}

/* Thousandths of the unit in steps. */
static uint16_t steps(uint16_t length, uint8_t axis)
{
    factor_1 = length;
    factor_2 = screen_unit();
    divisor = settings[SETTING_STEP_X_NM + axis];
    return proportion();
}

/* Moves one axis by so many steps, at most to the end of its travel. */
static uint8_t move(uint8_t command, uint8_t axis, int16_t way)
{
    int16_t x = stream_position(AXIS_X);
    int16_t z = stream_position(AXIS_Z);
    int16_t at = axis == AXIS_X ? x : z;
    int16_t room;

    if (machine_homed) {
        if (way > -at) {
            way = -at;
        }
        room = -settings[SETTING_TRAVEL_X + axis] - at;
        if (way < room) {
            way = room;
        }
    }
    at += way;
    if (axis == AXIS_X) {
        x = at;
    } else {
        z = at;
    }
    return manual_begin(command, x, z, by_hand_rate(), 0);
}

uint8_t by_hand_jog(uint8_t key)
{
    uint8_t axis = AXIS_X;
    int16_t way = JOG_STEPS;

    if (key == KEY_LEFT || key == KEY_RIGHT) {
        axis = AXIS_Z;
    }
    if (by_hand_choice[CHOICE_SIZE] != CONTINUOUS) {
        way = (int16_t)steps(by_hand_distance(), axis);
    } else if (jogging == 0) {
        jogging = key + 1;
    }
    if (key == KEY_DOWN || key == KEY_LEFT || key == KEY_X_IN) {
        way = -way;
    }
    return move(COMMAND_JOG, axis, way);
}

uint8_t by_hand_zero(uint8_t axis)
{
    if (axis == AXIS_Z) {
        return machine_zero(AXIS_Z, 0);
    }
    if (settings[SETTING_PANEL_INCH] && by_hand_diameter > DIAMETER_MAX_MIL) {
        return ERROR_OUT_OF_RANGE;
    }
    return machine_zero(AXIS_X,
                        (int16_t)((steps(by_hand_diameter, AXIS_X) + 1) / 2));
}

uint8_t by_hand_touch(uint8_t axis)
{
    uint8_t error;

    manual_heard();
    error = move(COMMAND_TOUCH, axis, -TOUCH_STEPS);
    if (error == ERROR_OK) {
        touching = axis + 1;
    }
    return error;
}

uint8_t by_hand_go_zero(void)
{
    return manual_begin(COMMAND_GOTO, settings[SETTING_ZERO_X],
                        settings[SETTING_ZERO_Z], by_hand_rate(), 0);
}

uint8_t by_hand_poll(void)
{
    uint8_t axis;
    uint8_t error;

    if (jogging != 0 && keys_down != jogging - 1) {
        jogging = 0;
        machine_hold();
    }
    if (!touching) {
        return 0;
    }
    if (machine_state == STATE_TOUCHING) {
        manual_heard();
        return 0;
    }
    axis = touching - 1;
    touching = 0;
    if (!manual_contact) {
        return TEXT_NO_CONTACT;
    }
    error = by_hand_zero(axis);
    return error != ERROR_OK ? TEXT_ERROR + error : TEXT_ZERO_SET;
}
