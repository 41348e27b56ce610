/*
 * What each command of the link does: reads the request, asks the room it
 * concerns, writes the response.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Bytes and offsets: link/protocol.toml and docs/protocol.md.
 */
#ifndef COMMANDS_H
#define COMMANDS_H

#include <stdint.h>

/* Turns of 4 ms, or less, until main() goes to the boot loader; 0 = never. */
extern uint8_t commands_leaving;

/* Executes the request in frame_code, frame_payload, frame_length; called by
   frame_poll(). Returns the length of frame_response, at least 1. */
uint8_t commands_execute(void);

#endif
