/*
 * The display of the panel: 16 columns, two lines.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Whoever has something to show writes it to panel_screen; the display follows
 * within 70 ms. A line begins with its command (LCD_LINE_1, LCD_LINE_2), then
 * its 16 characters: ASCII from blank to }, and from 1 on the letters of
 * menus.toml. Main loop only.
 *
 * With the setting `panel` at 0 the pins are inputs and nothing is written;
 * set to something else, the display is started as after power-on.
 */
#ifndef LCD_H
#define LCD_H

#include <stdint.h>

#define LCD_COLUMNS 16
#define LCD_LINE_1 0x80 /* commands: next character to this line */
#define LCD_LINE_2 0xC0
#define LINE_1 1 /* first characters in panel_screen */
#define LINE_2 18
#define LCD_SCREEN_SIZE 34

extern uint8_t panel_screen[LCD_SCREEN_SIZE];

/* Sends the next byte: 55 cycles. Called when 2 ms or more have passed. */
void lcd_poll(void);

#endif
