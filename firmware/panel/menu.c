/* The panel's menus.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/menu.h"
#include "arithmetic.h"     /* digits */
#include "lathe/homing.h"   /* spread */
#include "lathe/machine.h"  /* actions */
#include "link/protocol.h"  /* settings, errors */
#include "motion/path.h"    /* dead steps */
#include "panel/by_hand.h"  /* jog, part zero */
#include "panel/ladder.h"   /* keys */
#include "panel/lcd.h"      /* panel_screen */
#include "panel/menus.h"    /* entries */
#include "panel/screen.h"   /* texts, numbers */
#include "store/parts.h"    /* name of the part */
#include "store/settings.h" /* settings */

#define TAKE_KIND(kind, with) (kind),
#define TAKE_WITH(kind, with) (with),

static __code const uint8_t kinds[] = {MENU_ENTRIES(TAKE_KIND)};
static __code const uint8_t withs[] = {MENU_ENTRIES(TAKE_WITH)};

/* Largest step of a number that is being changed. */
#define STEP_MAX 10000u

static uint8_t entry;
static uint8_t first;   /* of its menu */
static uint8_t parent;  /* entry that led to this menu */
static uint8_t moving;  /* the keys move the slides */
static uint16_t step;   /* of the number being changed, 0 when none is */
static uint16_t number; /* it */

static uint8_t kind(void)
{
    return kinds[entry] & (uint8_t)~MENU_LAST;
}

void menu_leave(void)
{
    moving = 0;
    step = 0;
}

static uint16_t stored(void)
{
    return kind() == KIND_DIAMETER ? by_hand_diameter
                                   : (uint16_t)settings[withs[entry]];
}

static uint8_t change(uint8_t key)
{
    switch (key) {
    case KEY_UP:
        number += step;
        break;
    case KEY_DOWN:
        number -= step;
        break;
    case KEY_RIGHT:
        if (step != 1) {
            step /= 10;
        }
        break;
    case KEY_LEFT:
        step = step == STEP_MAX ? 0 : step * 10;
        break;
    case KEY_OK:
        step = 0;
        if (kind() == KIND_SETTING) {
            return machine_set(withs[entry], (int16_t)number);
        }
        by_hand_diameter = number;
        break;
    default:
        step = 0;
        break;
    }
    return ERROR_OK;
}

static uint8_t act(void)
{
    uint8_t with = withs[entry];

    switch (kind()) {
    case KIND_HOME:
        return machine_home(HOMED_ALL);
    case KIND_MOVE:
        moving = 1;
        break;
    case KIND_ZERO:
        return by_hand_zero(with);
    case KIND_TOUCH:
        return by_hand_touch(with);
    case KIND_GO_ZERO:
        return by_hand_go_zero();
    case KIND_RUN:
        return machine_run(SLOT_NONE, with);
    case KIND_PART:
        parts_select_next();
        break;
    case KIND_MENU:
        parent = entry;
        first = with;
        entry = with;
        break;
    case KIND_CHOICE:
        by_hand_choice[with] = (by_hand_choice[with] + 1) % CHOICES;
        break;
    case KIND_LANGUAGE:
        return machine_set(SETTING_PANEL, 3 - settings[SETTING_PANEL]);
    case KIND_DEAD:
        break;
    default:
        number = stored();
        step = 1;
        break;
    }
    return ERROR_OK;
}

static uint8_t go(uint8_t key)
{
    switch (key) {
    case KEY_UP:
        if (entry != first) {
            entry--;
        }
        break;
    case KEY_DOWN:
        if (!(kinds[entry] & MENU_LAST)) {
            entry++;
        }
        break;
    case KEY_RIGHT:
    case KEY_OK:
        return act();
    case KEY_LEFT:
    case KEY_BACK:
        if (first != 0) {
            entry = parent;
            first = 0;
        }
        break;
    default:
        break;
    }
    return ERROR_OK;
}

uint8_t menu_key(uint8_t key)
{
    uint8_t error;

    if (step != 0) {
        error = change(key);
    } else if (!moving) {
        error = go(key);
    } else if (key == KEY_OK || key == KEY_BACK) {
        moving = 0;
        return 0;
    } else {
        error = by_hand_jog(key);
        if (error == ERROR_BUSY) {
            return 0; /* the step before is still being made */
        }
    }
    return error != ERROR_OK ? TEXT_ERROR + error : 0;
}

void menu_show_text(void)
{
    screen_text(LINE_1, TEXT_ENTRY + entry);
}

static void show_number(uint16_t value)
{
    if (kind() == KIND_DIAMETER) {
        screen_point = 1;
    } else if ((int16_t)value < 0) {
        screen_negative = 1;
        value = -value;
    }
    screen_whole(LINE_2 + 7, LINE_2_END, value);
}

static void show_part(void)
{
    uint8_t slot = parts_selected();
    uint8_t i;

    if (slot == SLOT_NONE) {
        screen_text(LINE_2, TEXT_ERROR + ERROR_NO_PART);
        return;
    }
    parts_read_name(slot);
    screen_clear(LINE_2);
    for (i = 0; i < NAME_LENGTH && parts_name[i] != 0; i++) {
        panel_screen[LINE_2 + i] = parts_name[i];
    }
}

static void show_dead(uint8_t axis)
{
    uint8_t at = LINE_2 + LCD_COLUMNS / 2 * axis;

    panel_screen[at] = 'X' + ('Z' - 'X') * axis;
    screen_whole(at + 1, at + 4,
                 axis == AXIS_X ? motion_dead_x : motion_dead_z);
    screen_whole(at + 5, at + 7, homing_spread[axis]);
}

static void show_choice(uint8_t choice)
{
    uint16_t value =
        choice == CHOICE_SIZE ? by_hand_distance() : by_hand_rate();

    if (value == 0) {
        screen_text(LINE_2, TEXT_CONTINUOUS + choice);
    } else {
        screen_point = choice == CHOICE_SIZE;
        screen_whole(LINE_2, LINE_2_END, value);
    }
}

void menu_show_value(uint8_t part)
{
    uint8_t what = kind();

    if (what == KIND_DEAD) {
        show_dead(part);
    } else if (what <= KIND_GO_ZERO) {
        screen_position(part);
    } else if (part != 0) {
        return;
    } else if (what <= KIND_PART) {
        show_part();
    } else if (what == KIND_CHOICE) {
        show_choice(withs[entry]);
    } else if (what == KIND_LANGUAGE) {
        screen_text(LINE_2, TEXT_LANGUAGE);
    } else {
        screen_clear(LINE_2);
        if (step != 0) {
            screen_point = what == KIND_DIAMETER;
            screen_whole(LINE_2, LINE_2 + 6, step);
            show_number(number);
        } else if (what != KIND_MENU) {
            show_number(stored());
        }
    }
}
