/*
 * Lengths: the payload of a request must have that of its command.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef LENGTHS_H
#define LENGTHS_H

#include <stdint.h>

/* 1 when frame_length suits frame_code, or the command is not known. */
uint8_t lengths_fit(void);

#endif
