/* States of the machine on the panel.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/panel.h"
#include "arithmetic.h"     /* time left */
#include "lathe/machine.h"  /* state, progress */
#include "lathe/part.h"     /* record of a pause */
#include "lathe/passes.h"   /* operation, pass */
#include "link/protocol.h"  /* states, errors */
#include "panel/by_hand.h"  /* end of a touch or jog */
#include "panel/keys.h"     /* keys */
#include "panel/ladder.h"   /* KEY_... */
#include "panel/lcd.h"      /* panel_screen */
#include "panel/menu.h"     /* menus */
#include "panel/menus.h"    /* texts */
#include "panel/screen.h"   /* texts, numbers */
#include "store/flash.h"    /* message of a pause */
#include "store/parts.h"    /* the part */
#include "store/settings.h" /* fitted or not */
#include "tick.h"           /* time */

#define TAKE_WAY(way) (way),
static __code const uint8_t ways[] = {ALARM_WAYS(TAKE_WAY)};

/* An answer stands for so long, ms. */
#define ANSWER_MS 1500

/* Pieces of the lines are written one after the other, all of them in 32 ms:
   these bits of the time tell which. */
#define TURNS 0x1C
#define TURN 4 /* ms */

#define OVERRIDE_STEP 10
#define TIME_AT 11 /* place in the first line, from 0 */

#define PROGRESS_UNIT 4 /* permille */
#define PROGRESS_DONE (PERMILLE_DONE / PROGRESS_UNIT)

static uint8_t answer; /* text, 0 none */
static uint16_t answer_at;
static uint8_t column; /* behind the operation */
static uint8_t override;
static uint8_t override_shown; /* instead of the time left */
static uint16_t second_at;
static uint16_t elapsed; /* of the run, s */
static uint16_t left;    /* the same, 0 not known */
static uint8_t begun;    /* progress when it began, in PROGRESS_UNIT */
static uint8_t seen;     /* progress seen last */

static void show_answer(uint8_t text)
{
    answer = text;
    answer_at = tick_now();
}

static void run_key(uint8_t key)
{
    uint8_t percent = override + OVERRIDE_STEP;

    if (key > KEY_DOWN) {
        return;
    }
    if (key == KEY_DOWN) {
        percent -= 2 * OVERRIDE_STEP;
    }
    if (machine_override(percent) == ERROR_OK) {
        override = percent;
    }
    override_shown = 1;
    answer_at = tick_now();
}

static void take_key(uint8_t key)
{
    uint8_t error;

    if (machine_running()) {
        run_key(key);
    } else if (machine_state == STATE_ALARM) {
        if (key == KEY_OK) {
            error = machine_reset();
            if (error != ERROR_OK) {
                show_answer(TEXT_ERROR + error);
            }
        }
    } else {
        show_answer(menu_key(key));
    }
}

/* Counts the seconds of a run without its holds. When a pass has been
   completed, what is left is taken to go on as it did so far; then it counts
   down. */
static void count_time(void)
{
    uint16_t now = tick_now();
    uint8_t progress = (uint8_t)(machine_permille() / PROGRESS_UNIT);

    if (!machine_running()) {
        if (elapsed != 0 && progress == PROGRESS_DONE) {
            show_answer(TEXT_FINISHED);
        }
        elapsed = 0;
        left = 0;
        override = 100;
    }
    if (machine_state != STATE_RUNNING) {
        second_at = now;
        return;
    }
    if (elapsed == 0) {
        begun = progress;
        seen = progress;
    }
    if (now - second_at >= 1000) {
        second_at += 1000;
        elapsed++;
        if (left != 0) {
            left--;
        }
    }
    if (progress > seen) {
        seen = progress;
        factor_1 = elapsed;
        factor_2 = PROGRESS_DONE - progress;
        divisor = progress - begun;
        left = proportion();
    }
}

static void show_left(void)
{
    uint16_t seconds = left % 60;

    if (left == 0) {
        screen_clear(LINE_1 + TIME_AT);
        return;
    }
    screen_whole(LINE_1 + TIME_AT, LINE_1 + TIME_AT + 1, left / 60);
    panel_screen[LINE_1 + TIME_AT + 2] = ':';
    panel_screen[LINE_1 + TIME_AT + 3] = (uint8_t)(seconds / 10) + '0';
    panel_screen[LINE_1 + TIME_AT + 4] = (uint8_t)(seconds % 10) + '0';
}

static void show_status(void)
{
    if (override_shown) {
        screen_whole(LINE_1 + TIME_AT, LINE_1_END - 1, override);
        panel_screen[LINE_1_END] = '%';
    } else if (machine_state == STATE_RUNNING) {
        show_left();
    } else {
        screen_text(LINE_1 + TIME_AT, TEXT_STATE + machine_state);
    }
}

/* Returns the place behind it. */
static uint8_t show_short(uint8_t at, uint8_t value)
{
    uint8_t end = at;

    if (value > 9) {
        end++;
    }
    if (value > 99) {
        end++;
    }
    screen_whole(at, end, value);
    return end + 1;
}

static void show_operation(void)
{
    column = show_short(LINE_1, passes_operation());
    panel_screen[column] = '/';
    column = show_short(column + 1, part_operations);
    panel_screen[column] = ' ';
}

/* Behind the operation. */
static void show_pass(void)
{
    uint8_t at = show_short(column + 1, passes_pass());

    panel_screen[at] = '/';
    at = show_short(at + 1, passes_passes());
    while (at < LINE_1 + TIME_AT) {
        panel_screen[at] = ' ';
        at++;
    }
}

/* Message or tool of the record that the part waits at; 16 of its characters
   at a time. */
static uint8_t show_message(void)
{
    uint8_t i;
    uint8_t offset = 0;
    uint8_t character;
    uint8_t room = (uint8_t)(part_size - OPERATION_PAUSE_MESSAGE_AT);

    if (part_type == OPERATION_TOOL) {
        room = TOOL_NAME_LENGTH;
    } else if (part_type != OPERATION_PAUSE) {
        return 0;
    } else if (room > LCD_COLUMNS && tick_now() & 0x800) {
        offset = LCD_COLUMNS;
    }
    parts_open(machine_slot);
    parts_seek(part_record + OPERATION_PAUSE_MESSAGE_AT + offset);
    screen_clear(LINE_2);
    for (i = 0; i < LCD_COLUMNS && offset + i < room; i++) {
        character = flash_read();
        if (character != 0) {
            panel_screen[LINE_2 + i] = character;
        }
    }
    return 1;
}

static void show_alarm(void)
{
    screen_text(LINE_1, TEXT_ALARM + machine_alarm);
    if (ways[machine_alarm] & WAY_AXIS) {
        panel_screen[LINE_1_END] = 'X' + ('Z' - 'X') * machine_alarm_detail;
    }
}

static void first_line(void)
{
    if (machine_state == STATE_ALARM) {
        menu_leave();
        show_alarm();
    } else if (machine_running()) {
        menu_leave();
        show_operation();
    } else if (machine_state == STATE_HOMING ||
               machine_state == STATE_TOUCHING) {
        screen_text(LINE_1, TEXT_STATE + machine_state);
    } else {
        menu_show_text();
    }
}

static void second_line(uint8_t part)
{
    if (answer != 0) {
        screen_text(LINE_2, answer);
    } else if (machine_state == STATE_ALARM) {
        screen_text(LINE_2,
                    TEXT_WAY + (ways[machine_alarm] & (uint8_t)~WAY_AXIS));
    } else if (machine_state == STATE_PAUSE && show_message()) {
        return;
    } else if (!machine_quiet()) {
        screen_position(part);
    } else {
        menu_show_value(part);
    }
}

void panel_poll(void)
{
    uint8_t key;
    uint8_t text;

    if (!(uint8_t)settings[SETTING_PANEL]) {
        return;
    }
    panel_screen[LINE_1 - 1] = LCD_LINE_1;
    panel_screen[LINE_2 - 1] = LCD_LINE_2;
    key = keys_poll();
    if (key != KEY_NONE) {
        take_key(key);
    }
    text = by_hand_poll();
    if (text != 0) {
        show_answer(text);
    }
    switch ((uint8_t)tick_now() & TURNS) {
    case 0:
        count_time();
        if (tick_now() - answer_at >= ANSWER_MS) {
            answer = 0;
            override_shown = 0;
        }
        break;
    case 1 * TURN:
        first_line();
        break;
    case 2 * TURN:
        if (machine_running()) {
            show_pass();
        }
        break;
    case 3 * TURN:
        if (machine_running()) {
            show_status();
        }
        break;
    case 5 * TURN:
        second_line(0);
        break;
    case 7 * TURN:
        second_line(1);
        break;
    default:
        break;
    }
}
