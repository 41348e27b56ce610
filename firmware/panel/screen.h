/*
 * What is written to the display: texts, numbers, positions.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Places are those of panel_screen (lcd.h). Nothing here takes longer than
 * 1 ms or so, and the step queue is filled up before (path_keep_up()).
 *
 * Main loop only.
 */
#ifndef SCREEN_H
#define SCREEN_H

#include <stdint.h>

#define LINE_1_END 16 /* last characters */
#define LINE_2_END 33

/* A text (TEXT_... of menus.h) from a place to the end of its line. */
void screen_text(uint8_t at, uint8_t number);

/* Blanks from a place to the end of its line. */
void screen_clear(uint8_t at);

/* What proportion() has found, right-aligned between two places; an asterisk
   comes first when it is too long. */
void screen_number(uint8_t from, uint8_t to);
extern uint8_t screen_negative; /* a minus sign; taken back */
extern uint8_t screen_point;    /* three decimals; taken back */

/* The same with a whole number of 16 bits. */
void screen_whole(uint8_t from, uint8_t to, uint16_t value);

/* Nanometres of the last decimal: thousandths of a millimetre or inch. */
uint16_t screen_unit(void);

/* Where the tool is, X as a diameter, in the second line: one axis of it; or
   that nobody knows. */
void screen_position(uint8_t axis);

#endif
