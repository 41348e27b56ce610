/*
 * The panel: what the display shows in each state of the machine, and whose
 * the keys are.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   ALARM     what has happened, and the way out; OK acknowledges it
 *   RUNNING   operation / operations, pass / passes, time left; where the tool
 *   HOLD      is; UP and DOWN change the feed by ten percent
 *   PAUSE     the same, with the message of the part, or the tool it wants
 *   else      the menus (menu.h)
 *
 * Main loop only.
 */
#ifndef PANEL_H
#define PANEL_H

/* Every 4 ms; takes up to 2 ms while a part is cut, 3 ms at rest. Does nothing
   with the setting `panel` at 0. */
void panel_poll(void);

#endif
