/* What the guard stops a move at. Apart from guard.c, which belongs to an
   interrupt and cannot be byte code.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/guard.h"

void guard_stop_at(uint8_t input, uint8_t level)
{
    guard_stop_input = 0;
    guard_stop_inverted = level ? 0 : input;
    guard_stopped = 0;
    guard_stop_input = input;
}
