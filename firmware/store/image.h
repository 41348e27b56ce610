/*
 * The image that parts_seek() moves in: called for every piece of a contour,
 * so it is native code, which the rest of the part store is not.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef IMAGE_H
#define IMAGE_H

#include <stdint.h>

extern uint16_t image_begin; /* address in flash, set by parts_open() */

#endif
