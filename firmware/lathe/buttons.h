/*
 * What RUN, HOLD and STOP mean in the present state: see lathe/machine.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Main loop only.
 */
#ifndef BUTTONS_H
#define BUTTONS_H

/* Does what has been pressed or let go since the last call. */
void buttons_poll(void);

#endif
