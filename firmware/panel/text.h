/*
 * Texts of the panel in the language that the setting `panel` chooses.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Numbers of texts: TEXT_... in menus.h. Main loop only.
 */
#ifndef TEXT_H
#define TEXT_H

#include <stdint.h>

extern uint8_t text_number;
extern uint8_t text_at;   /* place in panel_screen */
extern uint8_t text_room; /* columns, at least 1; blanks fill what is left */

/* Writes the text into panel_screen; at most 0.7 ms. */
void text_show(void);

#endif
