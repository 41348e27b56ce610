/*
 * The menus: which entry is shown, what its keys do.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * menus.toml has the entries. UP and DOWN go to the entry before and behind,
 * OK or RIGHT does what it says, BACK or LEFT leaves a submenu. A number is
 * changed after OK: UP and DOWN add and take off, LEFT and RIGHT choose how
 * much, OK takes it, BACK leaves it as it was, and so does LEFT beyond the
 * largest step, for panels without BACK.
 *
 * Main loop only.
 */
#ifndef MENU_H
#define MENU_H

#include <stdint.h>

/* A key has gone down while nothing else on the display wants it. Returns the
   text that answers (TEXT_...), 0 for none. */
uint8_t menu_key(uint8_t key);

/* Leaves a number that is being changed, and moving by keys. */
void menu_leave(void);

/* Write the entry to the display: its text; then its second line in two
   parts, 0 and 1. */
void menu_show_text(void);
void menu_show_value(uint8_t part);

#endif
